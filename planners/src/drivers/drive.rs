//! What every driver provides: its settings, [`DriverKind`], and what plans with them, [`Drive`].

use std::any::Any;
use std::fmt;

use crate::plan::diagnostic::Explanation;
use crate::prediction::Prediction;
use crate::scene::input_record::InputRecord;
use crate::scene::outlook::Outlook;
use crate::scene::record::Record;
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
    /// With [`Prediction::Inferred`] the driver is told nobody's plan: its [`Planner`](crate::Planner) infers what the others
    /// will do, and the driver is given that.
    fn prediction(&self) -> Option<Prediction> {
        Some(Prediction::Plan)
    }

    /// Whether the driver is told the plans of the others; one who infers them is not.
    fn knows_plans(&self) -> bool {
        self.prediction() != Some(Prediction::Inferred)
    }

    /// Whether its plans branch: then its [`Outlook`] has what each of the others may do.
    fn branches(&self) -> bool {
        false
    }

    /// How long a plan of it takes, roughly, for budgets of scenarios. People, and whoever infers, are counted besides.
    fn plan_time(&self) -> PlanTime {
        PlanTime::UNKNOWN
    }

    /// Whether the driver plans before those who rely on knowing its plan. Its plans are then never refused: they are what the
    /// others have to live with.
    fn goes_first(&self) -> bool {
        false
    }

    /// Whether a plan that breaks a condition is refused, so that the vehicle drives something less harmful. Those who go first, and whoever
    /// decides from outside, drive as they do.
    fn may_be_refused(&self) -> bool {
        !self.goes_first() && !self.is_driven_from_outside()
    }

    /// Whether its inputs are handed in from outside, by whoever runs the simulation.
    fn is_driven_from_outside(&self) -> bool {
        self.inputs().is_some()
    }

    /// The inputs that were handed in once and are to be handed in again.
    fn inputs(&self) -> Option<&InputRecord> {
        None
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

    /// Checks settings that depend on each other, or on the number of steps of a plan.
    ///
    /// # Errors
    /// [`DriverSettingError`] names the setting that does not fit.
    fn check(&self, _horizon_steps: usize) -> Result<(), DriverSettingError> {
        Ok(())
    }
}

/// A driver with all that it remembers: a function from what it sees to a plan.
///
/// It has no clock, files or random numbers of its own, so that the same scenes give the same plans.
pub trait Drive: fmt::Debug + Send + Sync {
    /// Plans the next `scene.horizon` steps; the first input is applied. Called once a tick.
    ///
    /// `scene` has everybody as the driver senses them, with predictions as [`DriverKind::prediction`] asks for. `outlook` has
    /// what is inferred of the others' drivers; it is empty for a driver who is told plans.
    ///
    /// # Errors
    /// [`PlanError`] if there is no plan; the vehicle then drives a fallback.
    fn plan(&mut self, scene: &Scene, outlook: &Outlook) -> Result<Plan, PlanError>;

    /// A copy that remembers the same, for snapshots of a run. `None` for a driver that cannot be copied, such as one that
    /// asks another program.
    fn fork(&self) -> Option<Box<dyn Drive>> {
        None
    }

    /// The same driver with all that it remembers, and other settings of its kind. `None` if the settings are of another kind, or if it
    /// cannot change them: whoever asks then goes on with a new driver.
    fn with_settings(&self, _settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        None
    }
}

/// The settings themselves, if they are those of the kind `S`.
pub(crate) fn settings_of<S: DriverKind>(settings: &dyn DriverKind) -> Option<&S> {
    (settings as &dyn Any).downcast_ref()
}
