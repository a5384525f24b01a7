//! TEMP
use crate::frame::Frame;
use crate::watch::Watcher;
use interplay_scenarios::Scenario;
use std::path::PathBuf;
pub enum Sink {
    File(PathBuf),
    Live,
}
pub struct Recorder;
impl Recorder {
    pub fn begin(_: &Scenario, _: &str, _: &Sink) -> Result<Recorder, String> {
        Ok(Recorder)
    }
}
impl Watcher for Recorder {
    fn tick(&mut self, _: &Frame) -> Result<(), String> {
        Ok(())
    }
    fn finish(self: Box<Self>) -> Result<(), String> {
        Ok(())
    }
}
