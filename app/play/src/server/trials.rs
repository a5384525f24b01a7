//! A game in which people are walked through a study.

use super::game::Game;
use crate::protocol::{PageMessage, ServerMessage};
use crate::study::Study;

impl Game {
    /// Does what a page asks for in a study: it drives, and goes on when a run is over. Whoever stops time begins the run anew.
    pub(super) fn follow_study(&mut self, page: u64, message: PageMessage) -> Result<(), String> {
        let is_driving = self.playing.is_some();
        match message {
            PageMessage::Input { .. } if is_driving => self.follow(page, message),
            PageMessage::Pause { paused } if is_driving => {
                if paused && self.playing.as_ref().is_some_and(|playing| playing.session.ticks() > 0) {
                    self.playing = None;
                    self.study.as_mut().into_iter().for_each(Study::begin_again);
                    return self.begin_trial();
                }
                self.follow(page, message)
            }
            PageMessage::Echo { .. } => self.follow(page, message),
            PageMessage::Agree | PageMessage::Next if !is_driving => {
                if let Some(study) = self.study.as_mut().filter(|study| study.place().participant.is_none()) {
                    study.begin();
                }
                self.begin_trial()
            }
            PageMessage::Leave => {
                self.playing = None;
                self.study.as_mut().into_iter().for_each(Study::leave);
                self.tell_place();
                Ok(())
            }
            _ => Err("this is a study: drive to the end of the run, or leave".to_owned()),
        }
    }

    fn begin_trial(&mut self) -> Result<(), String> {
        let Some(study) = &self.study else { return Ok(()) };
        match study.next().map_err(|error| error.to_string())? {
            Some((name, scenario, seat)) => self.play(&name, &scenario, &seat),
            None => {
                self.tell_place();
                Ok(())
            }
        }
    }

    /// When a run of a study is over, it becomes a row, and the page asks whether to go on.
    pub(super) fn end_trial(&mut self) {
        let Some(study) = &mut self.study else { return };
        let Some(playing) = self.playing.take_if(|playing| playing.has_ended()) else { return };
        if let Err(error) = study.add(&playing.session) {
            self.tell(&ServerMessage::Refused { text: error.to_string() });
        }
        self.tell_place();
    }

    /// The last page has gone: the run that it drove is begun anew by the next.
    pub(super) fn drop_trial(&mut self) {
        if let Some(study) = &mut self.study
            && self.playing.take().is_some_and(|playing| playing.session.ticks() > 0)
        {
            study.begin_again();
        }
    }

    fn tell_place(&mut self) {
        if let Some(place) = self.study.as_ref().map(Study::place) {
            self.tell(&ServerMessage::Study { place });
        }
    }
}
