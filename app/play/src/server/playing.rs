//! A session in real time.

use std::path::PathBuf;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use interplay_presentation::stage::{StageFrame, StageObserver};
use interplay_scenarios::Scenario;

use super::ServeOptions;
use super::request::{PageAtGame, Request};
use crate::protocol::{PageMessage, ServerMessage};
use crate::session::{Controls, ScoreRow, Session, SessionError, planner_rows};
use crate::study::StudyPlace;

/// A player silent for this long is braked to a stop.
const SILENCE_LIMIT: Duration = Duration::from_millis(1000);
/// Least and greatest rate of time.
const RATES: [f64; 2] = [0.05, 16.0];
/// Time from the last goal or contact of a player to the end of the run, for a real car \[s\].
const TIME_AFTER_GOALS_S: f64 = 3.0;
/// Number of ticks over which the actual rate of time is measured.
const MEASURED_TICKS: usize = 20;
/// The controls of a seat without a page: full braking.
const BRAKING: Controls = Controls { seq: 0, acceleration: -1.0, steering: 0.0, assist: true };

/// A session in real time.
pub(super) struct Playing {
    pub session: Session,
    pub run: u64,
    /// The measures of planners from the same start.
    pub others: Option<Vec<ScoreRow>>,
    options: ServeOptions,
    requests: Sender<Request>,
    seats: Vec<PlayedSeat>,
    is_paused: bool,
    rate: f64,
    next: Instant,
    /// The times of the last ticks.
    tick_times: Vec<Instant>,
    stage_frame: StageFrame,
    /// The end of the run, after all players have reached a goal or had a contact \[s\].
    ends_s: Option<f64>,
    has_ended: bool,
    saved: Option<(usize, PathBuf)>,
    animation: String,
    /// The progress in a study.
    pub study: Option<StudyPlace>,
}

/// A seat, and the time of the last message of its person.
struct PlayedSeat {
    seat: String,
    last: Instant,
    is_braked: bool,
}

impl Playing {
    /// Starts a scenario with a person in a seat, and in the second seat of the options if the scenario has it.
    pub fn start(
        options: &ServeOptions,
        (name, scenario, seat): (&str, &Scenario, &str),
        run: u64,
        (requests, animation): (Sender<Request>, &str),
    ) -> Result<Playing, String> {
        let joined = options.joined.as_deref().filter(|joined| *joined != seat && scenario.index_of(joined).is_some());
        let seats: Vec<&str> = [seat].into_iter().chain(joined).collect();
        let session = Session::new(name, scenario, &seats).map_err(|error| error.to_string())?;
        let stage_frame = StageObserver::initial(&session.states());
        let now = Instant::now();
        let played_seat = |seat: &&str| PlayedSeat { seat: (*seat).to_owned(), last: now, is_braked: false };
        Ok(Playing {
            session,
            run,
            others: None,
            options: options.clone(),
            requests,
            seats: seats.iter().map(played_seat).collect(),
            is_paused: true,
            rate: 1.0,
            next: now,
            tick_times: Vec::new(),
            stage_frame,
            ends_s: None,
            has_ended: false,
            saved: None,
            animation: animation.to_owned(),
            study: None,
        })
    }

    pub fn main_seat(&self) -> &str {
        &self.seats[0].seat
    }

    /// The seat of a page: that of its address, if it is played, otherwise the first.
    pub fn seat_of(&self, page: &PageAtGame) -> &str {
        let named = self.seats.iter().find(|played| page.seat.as_ref() == Some(&played.seat));
        &named.unwrap_or(&self.seats[0]).seat
    }

    /// Sends the world and the present frame to a new page.
    pub fn welcome(&mut self, page: &PageAtGame) {
        let seat = self.seat_of(page).to_owned();
        let goal = self.session.goal(&seat);
        page.send(&ServerMessage::World {
            scenario: self.session.name().to_owned(),
            seats: crate::session::seats_of(self.session.written()),
            stage: Box::new(self.session.stage()),
            help: self.session.written().shows.clone(),
            goal,
            states: self.session.states().into_iter().map(interplay_planners::State::to_array).collect(),
            co_driver: crate::session::planners_beside_person().first().map(|driver| driver.kind()),
            study: self.study,
            seat,
        });
        page.send(&self.frame(page));
    }

    /// Brakes the vehicle of a page that has disconnected.
    pub fn dismiss(&mut self, page: &PageAtGame) {
        let seat = self.seat_of(page).to_owned();
        let _ = self.session.set_controls(&seat, BRAKING);
    }

    pub fn pause(&mut self, is_paused: bool) {
        if self.is_paused && !is_paused {
            self.next = Instant::now();
            self.tick_times.clear();
            self.seats.iter_mut().for_each(|played| played.last = self.next);
        }
        self.is_paused = is_paused;
    }

    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// Time until the next tick; `None` while paused.
    pub fn next_tick(&self, now: Instant) -> Option<Duration> {
        (!self.is_paused && !self.has_ended).then(|| self.next.saturating_duration_since(now))
    }

    /// Carries out a message of a page.
    pub fn follow(
        &mut self,
        page: &PageAtGame,
        message: PageMessage,
        pages: &[PageAtGame],
    ) -> Result<(), SessionError> {
        let seat = self.seat_of(page).to_owned();
        match message {
            PageMessage::Input { seq, acceleration, steering, assist } => {
                if self.is_paused
                    && !self.has_ended
                    && (acceleration != 0.0 || steering != 0.0)
                    && self.session.ticks() == 0
                {
                    self.pause(false);
                }
                if let Some(played) = self.seats.iter_mut().find(|played| played.seat == seat) {
                    (played.last, played.is_braked) = (Instant::now(), false);
                }
                self.session.set_controls(&seat, Controls { seq, acceleration, steering, assist })?;
            }
            PageMessage::Pause { paused } => {
                self.pause(paused);
                self.show(pages);
            }
            PageMessage::Rewind { seconds } => {
                self.session.rewind(seconds)?;
                (self.has_ended, self.ends_s, self.others) = (false, None, None);
                self.stage_frame = StageObserver::initial(&self.session.states());
                self.next = Instant::now();
                self.show(pages);
            }
            PageMessage::HandOver { to } => {
                self.session.hand_over(&seat, to.as_deref())?;
                self.show(pages);
            }
            PageMessage::Rate { ratio } => {
                let [least, most] = RATES;
                self.rate = if ratio.is_finite() { ratio.clamp(least, most) } else { 1.0 };
                (self.next, self.tick_times) = (Instant::now(), Vec::new());
                self.show(pages);
            }
            PageMessage::End => self.end(pages),
            _ => {}
        }
        Ok(())
    }

    /// Makes the next tick, if its time has come.
    pub fn tick_if_due(&mut self, now: Instant, pages: &[PageAtGame]) -> Result<(), SessionError> {
        if self.is_paused || self.has_ended || now < self.next {
            return Ok(());
        }
        self.brake_silent_seats(now)?;
        let Some(stage_frame) = self.session.tick()? else {
            self.end(pages);
            return Ok(());
        };
        self.stage_frame = stage_frame;
        let step = Duration::from_secs_f64(self.session.written().step_s / self.rate);
        self.tick_times.push(now);
        if self.tick_times.len() > MEASURED_TICKS {
            self.tick_times.remove(0);
        }
        // No tick is skipped; on a slow machine, simulated time advances more slowly instead.
        self.next = (self.next + step).max(Instant::now());
        self.show(pages);
        // In a study, every run lasts as long as the runs of the planners.
        if self.ends_s.is_none() && self.study.is_none() && self.session.is_decided() {
            let real = self.session.written().ego().map_or(1.0, |ego| ego.body.real_ratio().sqrt());
            self.ends_s = Some(self.session.time_s() + TIME_AFTER_GOALS_S * real);
        }
        if self.ends_s.is_some_and(|ends_s| self.session.time_s() >= ends_s) || self.session.is_over() {
            self.end(pages);
        }
        Ok(())
    }

    fn brake_silent_seats(&mut self, now: Instant) -> Result<(), SessionError> {
        for played in &mut self.seats {
            if !played.is_braked && now.duration_since(played.last) > SILENCE_LIMIT {
                played.is_braked = true;
                self.session.set_controls(&played.seat, BRAKING)?;
            }
        }
        Ok(())
    }

    /// Sends the present frame to every page.
    fn show(&self, pages: &[PageAtGame]) {
        for page in pages {
            page.send(&self.frame(page));
        }
    }

    /// The present frame for a page.
    fn frame(&self, page: &PageAtGame) -> ServerMessage {
        let seat = self.seat_of(page).to_owned();
        let (ack, planner) = self.session.wheel(&seat);
        ServerMessage::Frame {
            tick: self.session.ticks(),
            time_s: self.session.time_s(),
            real: self.rate,
            dilation: self.dilation(),
            paused: self.is_paused,
            driven_by: planner.unwrap_or("you").to_owned(),
            seat,
            ack,
            stage_frame: Box::new(self.stage_frame.clone()),
        }
    }

    /// The actual rate of time over the last ticks, as a share of the requested one.
    fn dilation(&self) -> f64 {
        let (Some(first), Some(last)) = (self.tick_times.first(), self.tick_times.last()) else { return 1.0 };
        let wanted_s = (self.tick_times.len() - 1) as f64 * self.session.written().step_s / self.rate;
        let took_s = last.duration_since(*first).as_secs_f64();
        if took_s > 0.0 && wanted_s > 0.0 { (wanted_s / took_s).min(1.0) } else { 1.0 }
    }

    /// Ends the run: saves and scores it, and starts the runs of planners.
    fn end(&mut self, pages: &[PageAtGame]) {
        if self.has_ended || self.session.ticks() == 0 {
            return;
        }
        self.has_ended = true;
        self.save();
        if self.study.is_some() {
            return;
        }
        self.send_score(pages);
        let (requests, run) = (self.requests.clone(), self.run);
        let (written, seat): (Scenario, String) = (self.session.written().clone(), self.main_seat().to_owned());
        let duration_s = written.duration_s;
        std::thread::spawn(move || {
            let rows = planner_rows(&written, &seat, duration_s).unwrap_or_default();
            let _ = requests.send(Request::Others { run, rows });
        });
    }

    /// Sends every page the score of its seat.
    pub fn send_score(&self, pages: &[PageAtGame]) {
        for page in pages {
            let mut score = self.session.score(self.seat_of(page));
            score.others = self.others.clone().unwrap_or_default();
            let saved = self.saved.as_ref().map(|(_, path)| path.display().to_string());
            let animation = Some(self.animation.clone());
            page.send(&ServerMessage::Score { score, saved, animation });
        }
    }

    /// Saves the played run, if it has changed since it was saved.
    pub fn save(&mut self) {
        let ticks = self.session.ticks();
        if ticks == 0 || self.saved.as_ref().is_some_and(|(saved, _)| *saved == ticks) {
            return;
        }
        match crate::script::save_played(&self.session, &self.options.folder) {
            Ok(path) => self.saved = Some((ticks, path)),
            Err(error) => self.saved = self.saved.take().or(Some((ticks, PathBuf::from(format!("nowhere: {error}"))))),
        }
    }

    /// The written and the played scenario, for an animation; `None` before the first tick.
    pub fn played(&self) -> Option<[Scenario; 2]> {
        (self.session.ticks() > 0).then(|| [self.session.written().clone(), self.session.played()])
    }
}
