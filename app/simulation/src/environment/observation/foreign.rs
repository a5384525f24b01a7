//! Views that other crates provide.

use std::fmt;
use std::sync::Arc;

use interplay_planners::Scene;
use interplay_planners::scene::driver_estimate::DriverEstimate;

use super::view::ObservationSpace;

/// A view of a scene that another crate provides.
pub trait ObservationKind: fmt::Debug + Send + Sync {
    /// The space of the view for a vehicle with a horizon.
    fn space(&self, horizon: usize) -> ObservationSpace;

    /// The fault of the settings, if there is one.
    fn fault(&self) -> Option<String> {
        None
    }

    /// Whether the view shows beliefs about the other drivers, which must then be inferred.
    fn shows_beliefs(&self) -> bool {
        false
    }

    /// Writes the view of a scene, as many numbers as its space has; `beliefs` is empty unless the view shows them.
    fn write(&self, scene: &Scene, beliefs: &[DriverEstimate], out: &mut [f32]);
}

/// A view of another crate among the views of an agent. It is stated only in code: settings read from a text do not name it.
#[derive(Clone, Debug)]
pub struct ForeignView(Arc<dyn ObservationKind>);

impl ForeignView {
    /// Wraps a view of another crate.
    pub fn new(view: impl ObservationKind + 'static) -> ForeignView {
        ForeignView(Arc::new(view))
    }

    pub(super) fn view(&self) -> &dyn ObservationKind {
        &*self.0
    }
}

/// A view equals only its own copies.
impl PartialEq for ForeignView {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
