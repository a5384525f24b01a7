//! Interplay: planners for vehicles that interact.
//!
//! The crate contains only pure functions of plain values: a planner receives a [`Scene`] (the knowledge of one vehicle
//! at one time) and returns a [`Plan`] or a [`PlanError`]. It uses no clock, files, physics or pictures.
//!
//! - [`vehicle`]: state, input, body, limits, and the bicycle with its derivatives
//! - [`road`]: lanes, routes and the Frenet frame: where a vehicle may drive
//! - [`scene`]: what a driver is given: its own vehicle, the others, the rules and its goal
//! - [`plan`]: what a driver answers: a plan with its reasons, its homotopy class, and the certificate that checks it
//! - [`prediction`]: how other vehicles may move on; [`perception`]: what a driver senses of them and believes about them
//! - [`rules`]: right of way, lights, speed limits and what blocks a lane
//! - [`problem`]: from a scene to the terms of a trajectory problem; [`trajectory`]: the optimiser that solves it
//! - [`drivers`]: one module for each driver; [`Driver`] lists them, [`DriverKind`] is what the settings of each provide,
//!   and [`Drive`] is what plans with them
//! - [`planner`]: what every driver has around it: inference, certificate and deadline
//! - [`traffic`]: the closed loop of all vehicles on a road
//! - [`motion_prediction`]: predictions of one recorded vehicle, by several models
//!
//! Sines, exponentials and similar functions come from `libm`, so that results are bit-identical on every machine.
//!
//! Equation numbers are those of C. Peng, *Optimization Based Control for Multi-agent System with Interaction* (Berkeley,
//! 2019); "corrected" marks where the printed equation is in error.
//!
//! # A plan
//!
//! A driver that looks ahead brakes for a slower vehicle in its lane:
//!
//! ```
//! use interplay_planners::drivers::conservative;
//! use interplay_planners::prediction::constant_velocity;
//! use interplay_planners::rules::RoadRules;
//! use interplay_planners::scene::Knowledge;
//! use interplay_planners::scene::inferred_futures::InferredFutures;
//! use interplay_planners::{
//!     Agent, Body, Corridor, DriverKind, Goal, Input, Limits, SafetyEllipse, Scene, State,
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
//!         indicator: None,
//!         rules: RoadRules::default(),
//!         urgency: 1.0,
//!         own_place: Default::default(),
//!     }
//! };
//! let (ego, leader) = (agent("ego", 0.0, 1.2), agent("leader", 1.2, 0.4));
//! let goal = Goal {
//!     target: ego.state,
//!     tracking: [0.0, 1.0, 0.5, 1.0],
//!     comfort: [0.1, 0.1],
//!     safety: SafetyEllipse::default(),
//! };
//! let scene = Scene { tick: 0, step_s, horizon, knowledge: Knowledge::Plans, ego, goal, others: vec![leader] };
//!
//! let plan = conservative::Settings::default().driver().plan(&scene, &InferredFutures::default())?;
//! assert_eq!(plan.trajectory.inputs.len(), horizon);
//! let slowest_mps = plan.trajectory.states.iter().map(|state| state.speed_mps).fold(f64::INFINITY, f64::min);
//! assert!(slowest_mps < 0.8, "it brakes to {slowest_mps} m/s");
//! # Ok::<(), interplay_planners::PlanError>(())
//! ```

pub mod drivers;
#[cfg(test)]
mod fixture;
pub mod motion_prediction;
pub mod perception;
pub mod plan;
pub mod planner;
pub mod prediction;
pub mod problem;
pub mod road;
pub mod rules;
pub mod scene;
pub mod traffic;
pub mod trajectory;
pub mod vehicle;

pub use drivers::{Drive, Driver, DriverKind, DriverSettingError, ForeignDriver, StandardReplacement};
pub use plan::homotopy::homotopy_class;
pub use plan::{
    Diagnostic, PassingSide, Plan, PlanBranch, PlanCondition, PlanError, PlanEvent, PlanEventKind, PlanTime,
    PlanViolation, PlannedPassing, Proposal,
};
pub use planner::{PlanDeadline, Planner};
pub use road::{Axes, CentreLine, Corridor, LaneEnd, Profile, Route};
pub use scene::{Agent, Goal, InputRecord, Scene};
pub use vehicle::{Bicycle, Body, ComfortLimits, EllipticalDistance, Input, Limits, SafetyEllipse, State, Trajectory};
