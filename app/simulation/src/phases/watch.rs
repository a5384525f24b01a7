//! Record: every tick is shown to whoever watches: a recorder, a progress bar.

use std::error::Error;

use bevy_ecs::prelude::*;

use crate::state::components::CurrentFrame;
use crate::state::frame::Frame;

/// Why a watcher could not keep what it was shown.
pub type WatchError = Box<dyn Error + Send + Sync>;

/// A watcher, which is shown every tick of a run and cannot change it.
pub trait Watcher: Send + Sync {
    /// Looks at one tick.
    ///
    /// # Errors
    /// Anything, if it cannot be kept; the run goes on and reports the first of them at its end.
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError>;

    /// The run is over.
    ///
    /// # Errors
    /// Anything, if what was seen cannot be kept.
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

    /// Ends the watch and tells every watcher so.
    ///
    /// # Errors
    /// The first thing that went wrong.
    pub fn finish(self) -> Result<(), WatchError> {
        let mut failure = self.failure;
        for watcher in self.watchers {
            let ended = watcher.finish();
            failure = failure.or(ended.err());
        }
        failure.map_or(Ok(()), Err)
    }
}

/// Shows the tick to everybody.
pub fn show(current_frame: Res<CurrentFrame>, mut watchers: ResMut<Watchers>) {
    let Watchers { watchers, failure } = &mut *watchers;
    for watcher in watchers {
        if let Err(error) = watcher.tick(&current_frame.0) {
            failure.get_or_insert(error);
        }
    }
}
