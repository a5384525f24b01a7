//! What every driver provides: its settings, [`DriverKind`], and what plans with them, [`Drive`].

use std::any::Any;
use std::fmt;

use serde_json::{Map, Value as Json};

use crate::drivers::reaction::Reaction;
use crate::plan::diagnostic::Explanation;
use crate::prediction::Prediction;
use crate::scene::Moment;
use crate::scene::inferred_futures::InferredFutures;
use crate::scene::input_record::InputRecord;
use crate::scene::record::Record;
use crate::scene::road_rules::RuleKeeping;
use crate::{DriverSettingError, Goal, Plan, PlanError, PlanTime, Scene};

/// The settings of one kind of driver, with all that is known of such a driver before it plans.
///
/// A kind of one's own implements [`kind`](DriverKind::kind) and [`driver`](DriverKind::driver), and whatever differs from the
/// defaults. In a scenario file its settings need `serde` and `schemars` besides; `interplay_scenarios::Registry` takes them.
pub trait DriverKind: Any + fmt::Debug + Send + Sync {
    /// The word for this kind in a scenario file: small letters, digits and hyphens.
    fn kind(&self) -> &'static str;

    /// A driver of this kind that has not planned yet.
    fn driver(&self) -> Box<dyn Drive>;

    /// What tells the results of this kind from those of its earlier versions, such as `env!("CARGO_PKG_VERSION")`: a sweep
    /// takes over no rows of another version. Kinds of Interplay leave it empty, since its version counts for all of them.
    fn version(&self) -> &'static str {
        ""
    }

    /// The driver in a few words, for legends.
    fn description(&self) -> String {
        self.kind().to_owned()
    }

    /// The quantities that its plans report, and how they are shown.
    fn explanation(&self) -> &'static Explanation {
        &Explanation::NONE
    }

    /// How the driver predicts the others; `None` for one who does not look at them.
    ///
    /// With [`Prediction::Inferred`] the driver knows no other plan: its [`Planner`](crate::Planner) infers what the others
    /// will do, and the driver is given that.
    fn prediction(&self) -> Option<Prediction> {
        Some(Prediction::Plan)
    }

    /// Whether the driver knows the plans of the others; one that infers them does not.
    fn knows_plans(&self) -> bool {
        self.prediction() != Some(Prediction::Inferred)
    }

    /// How late a driver of this kind observes the motion of the others, where it knows no plans \[s\].
    fn reaction_s(&self) -> f64 {
        0.0
    }

    /// How long it follows a slow vehicle before it overtakes on the lane of oncoming traffic, for 1/10 scale cars \[s\].
    fn patience_s(&self) -> f64 {
        0.0
    }

    /// Whether its plans branch: then its [`InferredFutures`] has what each of the others may do.
    fn branches(&self) -> bool {
        false
    }

    /// How long a plan of it takes, roughly, for budgets of scenarios. Human drivers and inference are counted separately.
    fn plan_time(&self) -> PlanTime {
        PlanTime::UNKNOWN
    }

    /// Whether the driver plans before drivers that rely on knowing its plan. Its plans are then never refused: they are what the
    /// others have to live with.
    fn goes_first(&self) -> bool {
        false
    }

    /// Whether it reacts to what it sees now and plans nothing ahead: among people it is then asked by [`Drive::react`].
    fn reacts(&self) -> bool {
        false
    }

    /// Whether a plan that breaks a condition is refused, so that the vehicle drives something less harmful. Drivers that go first, and
    /// drivers that decide from outside, drive as they do.
    fn may_be_refused(&self) -> bool {
        !self.goes_first() && !self.is_driven_from_outside()
    }

    /// Whether it decides for itself where it drives, so that its plan is refused where it gives away the last way out although the driver
    /// sees what comes. Scripts, records, walkers and inputs from outside are not.
    fn is_vetoed(&self) -> bool {
        self.prediction().is_some() && !self.is_driven_from_outside()
    }

    /// Whether its inputs are handed in from outside, by the caller of the simulation.
    fn is_driven_from_outside(&self) -> bool {
        self.inputs().is_some()
    }

    /// The inputs that were handed in once and are to be handed in again.
    fn inputs(&self) -> Option<&InputRecord> {
        None
    }

    /// Whether a run needs inputs from outside while it goes on: they were not recorded.
    fn awaits_inputs(&self) -> bool {
        self.is_driven_from_outside() && self.inputs().is_none()
    }

    /// Whether the driver can take the wheel from a person or an agent, with the default settings of its kind.
    fn can_take_wheel(&self) -> bool {
        !self.is_driven_from_outside()
    }

    /// Whether a person or an agent can drive in place of this driver.
    fn can_be_replaced(&self) -> bool {
        true
    }

    /// The motion that its vehicle carries out, whatever its inputs are; `None` for a driver whose inputs move it. While the record
    /// lasts, the others are told nothing of its plan.
    fn record(&self) -> Option<Record> {
        None
    }

    /// Whether the driver takes notice of vehicles outside its own lane, so that it can be asked to give way.
    fn can_be_asked(&self) -> bool {
        true
    }

    /// What a vehicle with this driver and goal tells the others that it wants; `None` for a driver who tells nothing.
    fn shared_goal(&self, _goal: &Goal) -> Option<Goal> {
        None
    }

    /// The settings of a real driver of this kind, by key and at full size, where a scenario of people leaves them out.
    fn people_defaults(&self) -> Map<String, Json> {
        Map::new()
    }

    /// Whether a vehicle with this driver keeps the rules of the road where a scenario of people leaves it out.
    fn people_rules(&self) -> RuleKeeping {
        RuleKeeping::Kept
    }

    /// The settings that follow from the width of the road's lanes \[m\], by key, where a scenario leaves them out.
    fn lane_defaults(&self, _lane_width_m: f64) -> Map<String, Json> {
        Map::new()
    }

    /// The place of this kind among the planners that `interplay why` tries instead of another one; `None` if it does not.
    fn replacement_in_why(&self) -> Option<StandardReplacement> {
        None
    }

    /// The rank of this kind among the planners that `interplay play` compares with a person, from 0; `None` if it does not. The
    /// first takes the wheel if a person hands it over.
    fn rank_beside_person(&self) -> Option<u8> {
        None
    }

    /// Checks settings that depend on each other, or on the number of steps of a plan.
    ///
    /// # Errors
    /// [`DriverSettingError`] names the setting that does not fit.
    fn check(&self, _horizon_steps: usize) -> Result<(), DriverSettingError> {
        Ok(())
    }
}

/// The place of a kind of driver among the planners that `interplay why` tries instead of another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandardReplacement {
    /// Planners of a lower rank are tried first.
    pub rank: u8,
    /// The factor on which the outcome depends if this planner changes it.
    pub factor: &'static str,
}

impl StandardReplacement {
    /// A planner that interacts.
    pub(crate) const fn planner(rank: u8) -> StandardReplacement {
        StandardReplacement { rank, factor: "planner" }
    }
}

/// A driver with all that it remembers: a function from what it sees to a plan.
///
/// It has no clock, files or random numbers of its own, so that the same scenes give the same plans.
pub trait Drive: fmt::Debug + Send + Sync {
    /// Plans the next `scene.horizon` steps; the first input is applied. Called once a tick.
    ///
    /// `scene` has all vehicles as the driver senses them, with predictions as [`DriverKind::prediction`] asks for. `inferred_futures` has
    /// what is inferred of the others' drivers; it is empty for a driver that knows plans.
    ///
    /// # Errors
    /// [`PlanError`] if no plan was found; the vehicle then drives a fallback.
    fn plan(&mut self, scene: &Scene, inferred_futures: &InferredFutures) -> Result<Plan, PlanError>;

    /// Answers with one input from what is around the vehicle now, in place of [`Drive::plan`]. `None` if the driver answers with plans only:
    /// then it is asked for a plan of one step. Called only if [`DriverKind::reacts`].
    fn react(&mut self, _moment: &Moment<'_>) -> Option<Reaction> {
        None
    }

    /// A copy that remembers the same, for snapshots of a run. `None` for a driver that cannot be copied, such as one that
    /// asks another program.
    fn fork(&self) -> Option<Box<dyn Drive>> {
        None
    }

    /// The same driver with all that it remembers, and other settings of its kind. `None` if the settings are of another kind, or if it
    /// cannot change them: the caller then goes on with a new driver.
    fn with_settings(&self, _settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        None
    }
}

/// The settings themselves, if they are those of the kind `S`.
pub(crate) fn settings_of<S: DriverKind>(settings: &dyn DriverKind) -> Option<&S> {
    (settings as &dyn Any).downcast_ref()
}
