//! The game: sessions in real time, and who sits where. It has a thread of its own; pages reach it by requests.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use interplay_scenarios::Scenario;
use serde_json::Error as JsonError;
use tokio::sync::{mpsc, oneshot};

use super::options::ServeOptions;
use super::playing::Playing;
use super::request::{PageAtGame, Request};
use crate::menu::Menu;
use crate::protocol::{Chosen, PageMessage, ServerMessage};
use crate::session::SessionError;
use crate::study::Study;

/// How long the game sleeps while nothing is played.
const IDLE: Duration = Duration::from_millis(250);
/// Most pages at a time.
const MOST_PAGES: usize = 16;

/// The game and all pages at it.
pub(super) struct Game {
    options: ServeOptions,
    /// The path of the moving picture.
    animation: String,
    received: Receiver<Request>,
    requests: Sender<Request>,
    pages: Vec<PageAtGame>,
    next_number: u64,
    next_run: u64,
    menu: Menu,
    playing: Option<Playing>,
    study: Option<Study>,
}

impl Game {
    pub fn new(
        options: ServeOptions,
        study: Option<Study>,
        animation: String,
        (received, requests): (Receiver<Request>, Sender<Request>),
    ) -> Game {
        let menu = Menu::of(&options.registry);
        Game {
            options,
            animation,
            received,
            requests,
            pages: Vec::new(),
            next_number: 1,
            next_run: 1,
            menu,
            playing: None,
            study,
        }
    }

    /// Plays until the server ends; what is being played then is kept.
    pub fn run(mut self) {
        if let Some((scenario, seat)) = self.options.chosen.clone() {
            self.start(&scenario, &seat);
        }
        loop {
            let now = Instant::now();
            let wait = self.playing.as_ref().and_then(|playing| playing.next_tick(now)).unwrap_or(IDLE);
            match self.received.recv_timeout(wait) {
                Ok(Request::Stop) | Err(RecvTimeoutError::Disconnected) => break,
                Ok(request) => self.answer(request),
                Err(RecvTimeoutError::Timeout) => {}
            }
            self.tick();
        }
        self.save();
        self.tell(&ServerMessage::Bye { text: "the server has ended".to_owned() });
    }

    fn answer(&mut self, request: Request) {
        match request {
            Request::Join { seat, outgoing, number } => self.join(seat, outgoing, number),
            Request::Said { page, text } => self.hear(page, &text),
            Request::Leave { page } => self.leave(page),
            Request::Animation { answer } => {
                let _ = answer.send(self.playing.as_ref().and_then(Playing::played));
            }
            Request::Others { run, rows } => {
                if let Some(playing) = self.playing.as_mut().filter(|playing| playing.run == run) {
                    playing.others = Some(rows);
                    playing.tell_score(&self.pages);
                }
            }
            Request::Stop => {}
        }
    }

    fn join(&mut self, seat: Option<String>, outgoing: mpsc::Sender<String>, number: oneshot::Sender<u64>) {
        if self.pages.len() >= MOST_PAGES {
            return;
        }
        // Whoever opens the address anew begins with what was asked for on the command line.
        if let (None, true, Some((scenario, seat))) =
            (&self.playing, self.pages.is_empty(), self.options.chosen.clone())
        {
            self.start(&scenario, &seat);
        }
        let page = PageAtGame::new(self.next_number, seat, outgoing);
        self.next_number += 1;
        let _ = number.send(page.number);
        let chosen = self.playing.as_ref().map(|playing| Chosen {
            scenario: playing.session.name().to_owned(),
            seat: playing.seat_of(&page).to_owned(),
        });
        match &self.study {
            Some(study) => page.send(&ServerMessage::Study { place: study.place() }),
            None => page.send(&ServerMessage::Menu { families: self.menu.families.clone(), chosen }),
        };
        if let Some(playing) = &mut self.playing {
            playing.come(&page);
        }
        self.pages.push(page);
    }

    /// A page is gone: its seat is braked. When the last one goes, time stands still and what was played is kept.
    fn leave(&mut self, number: u64) {
        let Some(place) = self.pages.iter().position(|page| page.number == number) else { return };
        let page = self.pages.remove(place);
        if let Some(playing) = &mut self.playing {
            playing.go(&page);
            if self.pages.is_empty() {
                playing.pause(true);
                self.save();
            }
        }
        if self.pages.is_empty() {
            self.drop_trial();
        }
    }

    /// Keeps what is being played. A run of a study is kept when it is over.
    fn save(&mut self) {
        if let Some(playing) = self.playing.as_mut().filter(|playing| playing.study.is_none()) {
            playing.save();
        }
    }

    fn tell(&mut self, message: &ServerMessage) {
        let gone: Vec<u64> = self.pages.iter().filter(|page| !page.send(message)).map(|page| page.number).collect();
        gone.into_iter().for_each(|page| self.leave(page));
    }

    fn refuse(&self, number: u64, text: &str) {
        if let Some(page) = self.pages.iter().find(|page| page.number == number) {
            page.send(&ServerMessage::Refused { text: text.to_owned() });
        }
    }

    fn hear(&mut self, number: u64, text: &str) {
        let message: Result<PageMessage, JsonError> = serde_json::from_str(text);
        let heard = match message {
            Ok(message) if self.study.is_some() => self.follow_study(number, message),
            Ok(message) => self.follow(number, message),
            Err(error) => {
                let reason = error.to_string();
                Err(format!("this is no message: {}", reason.split(" at line").next().unwrap_or_default()))
            }
        };
        if let Err(text) = heard {
            self.refuse(number, &text);
        }
    }

    /// Does what a page asks for, or says why not.
    fn follow(&mut self, number: u64, message: PageMessage) -> Result<(), String> {
        match message {
            PageMessage::Start { scenario, seat } => self.start_as(&scenario, &seat),
            PageMessage::Menu => {
                self.save();
                self.playing = None;
                let families = self.menu.families.clone();
                self.tell(&ServerMessage::Menu { families, chosen: None });
                Ok(())
            }
            PageMessage::Echo { at } => {
                if let Some(page) = self.pages.iter().find(|page| page.number == number) {
                    page.send(&ServerMessage::Echo { at });
                }
                Ok(())
            }
            PageMessage::Next => {
                let name = self.playing.as_ref().map(|playing| playing.session.name().to_owned()).unwrap_or_default();
                let Some((scenario, seat)) = self.menu.after(&name) else {
                    return Err("there is no next one".to_owned());
                };
                self.start_as(&scenario, &seat)
            }
            PageMessage::Seat { seat } => {
                let playing = self.playing.as_ref().ok_or("nothing is played: choose a scenario")?;
                let name = playing.session.name().to_owned();
                self.start_as(&name, &seat)
            }
            PageMessage::Restart => {
                let playing = self.playing.as_ref().ok_or("nothing is played: choose a scenario")?;
                let (name, seat) = (playing.session.name().to_owned(), playing.main_seat().to_owned());
                self.start_as(&name, &seat)
            }
            other => {
                let playing = self.playing.as_mut().ok_or("nothing is played: choose a scenario")?;
                let page = self.pages.iter().find(|page| page.number == number).ok_or("this page is gone")?;
                playing.follow(page, other, &self.pages).map_err(|error: SessionError| error.to_string())
            }
        }
    }

    fn start_as(&mut self, scenario: &str, seat: &str) -> Result<(), String> {
        let name = scenario;
        let scenario = self.options.registry.load(name, &[]).map_err(|error| {
            let faults: Vec<&str> = error.faults().iter().map(interplay_scenarios::Fault::message).collect();
            format!("{error}: {}", faults.join("; "))
        })?;
        self.play(name, &scenario, seat)
    }

    fn play(&mut self, name: &str, scenario: &Scenario, seat: &str) -> Result<(), String> {
        self.save();
        self.playing = None;
        let run = self.next_run;
        self.next_run += 1;
        let sender = (self.requests.clone(), self.animation.as_str());
        let playing = Playing::start(&self.options, (name, scenario, seat), run, sender)?;
        let study = self.study.as_ref().map(Study::place);
        let playing = self.playing.insert(playing);
        playing.study = study;
        self.pages.iter().for_each(|page| playing.come(page));
        Ok(())
    }

    /// The same where nobody hears why it cannot be.
    fn start(&mut self, scenario: &str, seat: &str) {
        if let Err(text) = self.start_as(scenario, seat) {
            self.tell(&ServerMessage::Refused { text });
        }
    }

    fn tick(&mut self) {
        let Some(playing) = &mut self.playing else { return };
        if let Err(error) = playing.tick_if_due(Instant::now(), &self.pages) {
            playing.pause(true);
            self.save();
            self.tell(&ServerMessage::Refused { text: error.to_string() });
        }
        self.end_trial();
    }

    /// Does what a page asks for in a study: it drives, and goes on when a run is over. Whoever stops time begins the run anew.
    fn follow_study(&mut self, page: u64, message: PageMessage) -> Result<(), String> {
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
    fn end_trial(&mut self) {
        let Some(study) = &mut self.study else { return };
        let Some(playing) = self.playing.take_if(|playing| playing.has_ended()) else { return };
        if let Err(error) = study.add(&playing.session) {
            self.tell(&ServerMessage::Refused { text: error.to_string() });
        }
        self.tell_place();
    }

    /// The last page has gone: the run that it drove is begun anew by the next.
    fn drop_trial(&mut self) {
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
