//! The game: the session in real time and its pages. It runs in its own thread and receives requests from pages.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use interplay_scenarios::Scenario;
use serde_json::Error as JsonError;
use tokio::sync::{mpsc, oneshot};

use super::ServeOptions;
use super::playing::Playing;
use super::request::{PageAtGame, Request};
use crate::protocol::{Chosen, Menu, PageMessage, ServerMessage};
use crate::session::SessionError;
use crate::study::Study;

/// Longest wait for a request without a running session.
const IDLE_WAIT: Duration = Duration::from_millis(250);
/// Most pages at a time.
const MAX_PAGES: usize = 16;

pub(super) struct Game {
    options: ServeOptions,
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

    /// Runs until the server ends, and then saves the played run.
    pub fn run(mut self) {
        if let Some((scenario, seat)) = self.options.chosen.clone() {
            self.start(&scenario, &seat);
        }
        loop {
            let now = Instant::now();
            let wait = self.playing.as_ref().and_then(|playing| playing.next_tick(now)).unwrap_or(IDLE_WAIT);
            match self.received.recv_timeout(wait) {
                Ok(Request::Stop) | Err(RecvTimeoutError::Disconnected) => break,
                Ok(request) => self.answer(request),
                Err(RecvTimeoutError::Timeout) => {}
            }
            self.tick();
        }
        self.save();
        self.broadcast(&ServerMessage::Bye { text: "the server has ended".to_owned() });
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
                    playing.send_score(&self.pages);
                }
            }
            Request::Stop => {}
        }
    }

    fn join(&mut self, seat: Option<String>, outgoing: mpsc::Sender<String>, number: oneshot::Sender<u64>) {
        if self.pages.len() >= MAX_PAGES {
            return;
        }
        // The first page shows the scenario of the command line.
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
            playing.welcome(&page);
        }
        self.pages.push(page);
    }

    /// Removes a page and brakes its seat. After the last page, pauses and saves the run.
    fn leave(&mut self, number: u64) {
        let Some(place) = self.pages.iter().position(|page| page.number == number) else { return };
        let page = self.pages.remove(place);
        if let Some(playing) = &mut self.playing {
            playing.dismiss(&page);
            if self.pages.is_empty() {
                playing.pause(true);
                self.save();
            }
        }
        if self.pages.is_empty() {
            self.drop_trial();
        }
    }

    /// Saves the played run. Runs of a study are saved only when they are finished.
    fn save(&mut self) {
        if let Some(playing) = self.playing.as_mut().filter(|playing| playing.study.is_none()) {
            playing.save();
        }
    }

    fn broadcast(&mut self, message: &ServerMessage) {
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
                Err(format!("not a message: {}", reason.split(" at line").next().unwrap_or_default()))
            }
        };
        if let Err(text) = heard {
            self.refuse(number, &text);
        }
    }

    /// Carries out a message of a page; an error is the reason for the refusal.
    fn follow(&mut self, number: u64, message: PageMessage) -> Result<(), String> {
        match message {
            PageMessage::Start { scenario, seat } => self.start_as(&scenario, &seat),
            PageMessage::Menu => {
                self.save();
                self.playing = None;
                let families = self.menu.families.clone();
                self.broadcast(&ServerMessage::Menu { families, chosen: None });
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
                    return Err("there are no other scenarios".to_owned());
                };
                self.start_as(&scenario, &seat)
            }
            PageMessage::Seat { seat } => {
                let playing = self.playing.as_ref().ok_or("no scenario is running: choose one")?;
                let name = playing.session.name().to_owned();
                self.start_as(&name, &seat)
            }
            PageMessage::Restart => {
                let playing = self.playing.as_ref().ok_or("no scenario is running: choose one")?;
                let (name, seat) = (playing.session.name().to_owned(), playing.main_seat().to_owned());
                self.start_as(&name, &seat)
            }
            other => {
                let playing = self.playing.as_mut().ok_or("no scenario is running: choose one")?;
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
        self.pages.iter().for_each(|page| playing.welcome(page));
        Ok(())
    }

    /// Starts a scenario, and tells all pages if it is refused.
    fn start(&mut self, scenario: &str, seat: &str) {
        if let Err(text) = self.start_as(scenario, seat) {
            self.broadcast(&ServerMessage::Refused { text });
        }
    }

    fn tick(&mut self) {
        let Some(playing) = &mut self.playing else { return };
        if let Err(error) = playing.tick_if_due(Instant::now(), &self.pages) {
            playing.pause(true);
            self.save();
            self.broadcast(&ServerMessage::Refused { text: error.to_string() });
        }
        self.end_trial();
    }

    /// Carries out a message of a page in a study. A person can only drive, continue and leave; a pause restarts the run.
    fn follow_study(&mut self, page: u64, message: PageMessage) -> Result<(), String> {
        let is_driving = self.playing.is_some();
        match message {
            PageMessage::Input { .. } if is_driving => self.follow(page, message),
            PageMessage::Pause { paused } if is_driving => {
                if paused && self.playing.as_ref().is_some_and(|playing| playing.session.ticks() > 0) {
                    self.playing = None;
                    self.study.as_mut().into_iter().for_each(Study::count_restart);
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
                self.send_place();
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
                self.send_place();
                Ok(())
            }
        }
    }

    /// Adds a finished run of a study as a row, and shows the page between runs.
    fn end_trial(&mut self) {
        let Some(study) = &mut self.study else { return };
        let Some(playing) = self.playing.take_if(|playing| playing.has_ended()) else { return };
        if let Err(error) = study.add(&playing.session) {
            self.broadcast(&ServerMessage::Refused { text: error.to_string() });
        }
        self.send_place();
    }

    /// Drops an unfinished run of a study after the last page is gone; the next page restarts it.
    fn drop_trial(&mut self) {
        if let Some(study) = &mut self.study
            && self.playing.take().is_some_and(|playing| playing.session.ticks() > 0)
        {
            study.count_restart();
        }
    }

    fn send_place(&mut self) {
        if let Some(place) = self.study.as_ref().map(Study::place) {
            self.broadcast(&ServerMessage::Study { place });
        }
    }
}
