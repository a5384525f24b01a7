//! Interplay: planners for vehicles that interact.
//!
//! Pure functions of plain values: a planner is given a [`Scene`] (what one vehicle knows at a moment) and answers with a
//! [`Plan`] or a [`PlanError`]. Nothing here knows of time, files, physics or pictures.
//!
//! - nouns: [`State`], [`Input`], [`Trajectory`], [`Body`], [`SafetyEllipse`], [`Corridor`], [`Scene`], [`Plan`]
//! - [`vehicle`]: state, body, limits and the bicycle with its derivatives
//! - [`road`]: where a vehicle may drive
//! - [`predict`]: what the others will do
//! - [`sensing`]: what a driver sees of them; [`belief`]: what it believes of their drivers
//! - drivers, one folder each: [`human`], [`idm`], [`scripted`], [`recorded`], [`external`], [`conservative`], [`cooperative`],
//!   [`negotiation`], [`bayesian`], [`game`], [`nash`], [`contingency`]; [`Driver`] lists them, [`DriverKind`] is what the
//!   settings of each provide, [`Drive`] what plans with them, and [`Planner`] what all of them have around it
//! - [`posing`]: from a scene to the terms of a trajectory problem, of one vehicle or of several that decide together
//! - [`motion_prediction`]: how one vehicle of real traffic goes on, by several models
//! - [`homotopy`]: before or behind whom a plan leads
//! - [`trajectory`]: one trajectory optimiser
//! - [`traffic`]: the closed loop of all vehicles on a road
//!
//! Sines, exponentials and the like come from `libm`, so that results are the same bit for bit on every machine.
//!
//! Equation numbers are those of C. Peng, *Optimization Based Control for Multi-agent System with Interaction* (Berkeley,
//! 2019); "corrected" marks where the printed equation is in error.
//!
//! # A plan
//!
//! A driver that looks ahead brakes for a slower vehicle in its lane:
//!
//! ```
//! use interplay_planners::outlook::Outlook;
//! use interplay_planners::predict::constant_velocity;
//! use interplay_planners::rules::RoadRules;
//! use interplay_planners::{
//!     Agent, Body, Corridor, DriverKind, Goal, Input, Limits, SafetyEllipse, Scene, State, conservative,
//! };
//!
//! let (step_s, horizon) = (0.1, 30);
//! let agent = |name: &str, x_m: f64, speed_mps: f64| {
//!     let state = State { x_m, y_m: 0.185, heading_rad: 0.0, speed_mps };
//!     Agent {
//!         name: name.to_owned(),
//!         state,
//!         previous_input: Input::default(),
//!         body: Body::default(),
//!         limits: Limits::default(),
//!         route: Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.37, end: None }.into(),
//!         prediction: constant_velocity(&state, horizon, step_s).into(),
//!         shared_goal: None,
//!         can_be_asked: true,
//!         is_obstacle: false,
//!         rules: RoadRules::default(),
//!         urgency: 1.0,
//!     }
//! };
//! let (ego, leader) = (agent("ego", 0.0, 1.2), agent("leader", 1.2, 0.4));
//! let goal = Goal {
//!     target: ego.state,
//!     tracking: [0.0, 1.0, 0.5, 1.0],
//!     comfort: [0.1, 0.1],
//!     safety: SafetyEllipse::default(),
//! };
//! let scene = Scene { tick: 0, step_s, horizon, ego, goal, others: vec![leader] };
//!
//! let plan = conservative::Settings::default().driver().plan(&scene, &Outlook::default())?;
//! assert_eq!(plan.trajectory.inputs.len(), horizon);
//! let slowest_mps = plan.trajectory.states.iter().map(|state| state.speed_mps).fold(f64::INFINITY, f64::min);
//! assert!(slowest_mps < 0.8, "it brakes to {slowest_mps} m/s");
//! # Ok::<(), interplay_planners::PlanError>(())
//! ```

pub mod bayesian;
pub mod belief;
pub mod certificate;
mod clearance;
pub mod conservative;
pub mod contingency;
pub mod cooperative;
mod deadline;
pub mod diagnostic;
mod drive;
mod driver;
pub mod driver_estimate;
mod driver_setting;
mod encounter;
pub mod external;
#[cfg(test)]
mod fixture;
mod foreign_driver;
pub mod game;
mod giving_way;
pub mod homotopy;
pub mod human;
pub mod idm;
mod input_record;
pub mod inputs;
pub mod lanes;
pub mod motion_prediction;
pub mod nash;
pub mod negotiation;
mod obstacle;
pub mod outlook;
mod permitted_speed;
mod plan;
mod plan_time;
mod plan_violation;
mod planned_passing;
mod planner;
pub mod posing;
pub mod predict;
mod receding_horizon;
mod record;
pub mod recorded;
mod relation;
mod right_of_way;
pub mod road;
mod road_rules;
pub mod rules;
mod scene;
pub mod scripted;
pub mod sensing;
mod steering;
pub mod traffic;
pub mod trajectory;
pub mod trigger;
mod urgency;
pub mod vehicle;
pub mod walker;

pub use deadline::PlanDeadline;
pub use diagnostic::Diagnostic;
pub use drive::{Drive, DriverKind};
pub use driver::Driver;
pub use driver_setting::DriverSettingError;
pub use foreign_driver::ForeignDriver;
pub use homotopy::homotopy_class;
pub use input_record::{InputRecord, WHEEL_KINDS};
pub use plan::{Plan, PlanBranch, PlanError, PlanEvent, PlanEventKind, Proposal};
pub use plan_time::PlanTime;
pub use plan_violation::{PlanCondition, PlanViolation};
pub use planned_passing::{PassingSide, PlannedPassing};
pub use planner::Planner;
pub use road::{Axes, CentreLine, Corridor, LaneEnd, Profile, Route};
pub use scene::{Agent, Goal, Scene};
pub use vehicle::{Bicycle, Body, ComfortLimits, EllipticalDistance, Input, Limits, SafetyEllipse, State, Trajectory};
