//! Views of other crates.

use std::fmt;
use std::sync::Arc;

use interplay_planners::Scene;
use interplay_planners::scene::driver_estimate::DriverEstimate;

use super::view::ObservationSpace;

/// A view of a scene that another crate provides.
pub trait ObservationKind: fmt::Debug + Send + Sync {
    /// The numbers of the view of a vehicle with a horizon.
    fn space(&self, horizon: usize) -> ObservationSpace;

    /// What is wrong with the settings, if anything.
    fn fault(&self) -> Option<String> {
        None
    }

    /// Whether it shows what is believed of the other drivers, which is then inferred.
    fn shows_beliefs(&self) -> bool {
        false
    }

    /// Writes the numbers of a scene, as many as its space has; `beliefs` is empty unless it shows them.
    fn write(&self, scene: &Scene, beliefs: &[DriverEstimate], out: &mut [f32]);
}

/// A view of another crate, as one of the views of an agent. It is stated in code: settings that are read from a text do not name it.
#[derive(Clone, Debug)]
pub struct ForeignView(Arc<dyn ObservationKind>);

impl ForeignView {
    /// The view.
    pub fn new(view: impl ObservationKind + 'static) -> ForeignView {
        ForeignView(Arc::new(view))
    }

    pub(super) fn view(&self) -> &dyn ObservationKind {
        &*self.0
    }
}

/// A view is the same as its copies alone.
impl PartialEq for ForeignView {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
