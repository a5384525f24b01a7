//! Record: passes every tick to the watchers, such as a recorder or a progress bar.

use std::error::Error;

use bevy_ecs::prelude::*;

use crate::state::components::CurrentFrame;
use crate::state::frame::Frame;

/// Why a watcher could not record a tick.
pub type WatchError = Box<dyn Error + Send + Sync>;

/// A watcher, which receives every tick of a run and cannot change it.
pub trait Watcher: Send + Sync {
    /// Receives one tick.
    ///
    /// # Errors
    /// Any error of recording; the run continues and reports the first of them at its end.
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError>;

    /// Receives the end of the run.
    ///
    /// # Errors
    /// Any error of recording.
    fn finish(self: Box<Self>) -> Result<(), WatchError>;
}

/// The watchers of a world.
#[derive(Resource, Default)]
pub struct Watchers {
    watchers: Vec<Box<dyn Watcher>>,
    failure: Option<WatchError>,
}

impl Watchers {
    /// The watchers of a world that has not begun.
    pub fn new(watchers: Vec<Box<dyn Watcher>>) -> Self {
        Watchers { watchers, failure: None }
    }

    /// Whether there are any.
    pub(crate) fn are_there(&self) -> bool {
        !self.watchers.is_empty()
    }

    /// Ends the run for every watcher.
    ///
    /// # Errors
    /// The first error of a watcher.
    pub fn finish(self) -> Result<(), WatchError> {
        let mut failure = self.failure;
        for watcher in self.watchers {
            let ended = watcher.finish();
            failure = failure.or(ended.err());
        }
        failure.map_or(Ok(()), Err)
    }
}

/// Passes the tick to all watchers.
pub fn show(current_frame: Res<CurrentFrame>, mut watchers: ResMut<Watchers>) {
    let Watchers { watchers, failure } = &mut *watchers;
    for watcher in watchers {
        if let Err(error) = watcher.tick(&current_frame.0) {
            failure.get_or_insert(error);
        }
    }
}
