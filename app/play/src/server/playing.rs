//! A session in real time.

use std::path::PathBuf;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use interplay_presentation::stage::{StageMoment, StageWitness};
use interplay_scenarios::Scenario;

use super::options::ServeOptions;
use super::request::{PageAtGame, Request};
use crate::protocol::{PageMessage, ServerMessage};
use crate::session::{ScoreRow, Session, SessionError, Wish, others};
use crate::study::StudyPlace;

/// Whoever is not heard for so long is braked.
const LATE: Duration = Duration::from_millis(1000);
/// Rates of time that can be chosen.
const RATES: [f64; 2] = [0.05, 16.0];
/// The run ends so long after everybody has reached the goal, for a real car \[s\].
const AFTER_S: f64 = 3.0;
/// The speed of time is measured over so many ticks.
const MEASURED: usize = 20;
/// A page that is away brakes like this.
const RETREAT: Wish = Wish { seq: 0, acceleration: -1.0, steering: 0.0, assist: true };

/// A session in real time, and who is heard in it.
pub(super) struct Playing {
    pub session: Session,
    pub run: u64,
    /// What planners did from the same start.
    pub others: Option<Vec<ScoreRow>>,
    options: ServeOptions,
    requests: Sender<Request>,
    seats: Vec<Heard>,
    is_paused: bool,
    rate: f64,
    next: Instant,
    /// When the last ticks were made.
    made: Vec<Instant>,
    moment: StageMoment,
    /// When the run ends, once everybody is done \[s\].
    ends_s: Option<f64>,
    has_ended: bool,
    saved: Option<(usize, PathBuf)>,
    /// The path of the moving picture.
    animation: String,
    /// Where in a study this is.
    pub study: Option<StudyPlace>,
}

/// A seat and when its person was heard last.
struct Heard {
    seat: String,
    last: Instant,
    is_braked: bool,
}

impl Playing {
    /// A scenario before its first tick, with people in a seat and in the one that others join.
    pub fn start(
        options: &ServeOptions,
        (name, scenario, seat): (&str, &Scenario, &str),
        run: u64,
        (requests, animation): (Sender<Request>, &str),
    ) -> Result<Playing, String> {
        let joined = options.joined.as_deref().filter(|joined| *joined != seat && scenario.index_of(joined).is_some());
        let seats: Vec<&str> = [seat].into_iter().chain(joined).collect();
        let session = Session::new(name, scenario, &seats).map_err(|error| error.to_string())?;
        let moment = StageWitness::standing(&session.states());
        let now = Instant::now();
        let heard = |seat: &&str| Heard { seat: (*seat).to_owned(), last: now, is_braked: false };
        Ok(Playing {
            session,
            run,
            others: None,
            options: options.clone(),
            requests,
            seats: seats.iter().map(heard).collect(),
            is_paused: true,
            rate: 1.0,
            next: now,
            made: Vec::new(),
            moment,
            ends_s: None,
            has_ended: false,
            saved: None,
            animation: animation.to_owned(),
            study: None,
        })
    }

    /// The first seat.
    pub fn main_seat(&self) -> &str {
        &self.seats[0].seat
    }

    /// The seat of a page: the one that its address names, if a person can have it, else the first.
    pub fn seat_of(&self, page: &PageAtGame) -> &str {
        let named = self.seats.iter().find(|heard| page.seat.as_ref() == Some(&heard.seat));
        &named.unwrap_or(&self.seats[0]).seat
    }

    /// A page comes: it is told the world, and what is seen.
    pub fn come(&mut self, page: &PageAtGame) {
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

    /// A page goes: its seat is braked.
    pub fn go(&mut self, page: &PageAtGame) {
        let seat = self.seat_of(page).to_owned();
        let _ = self.session.wish(&seat, RETREAT);
    }

    pub fn pause(&mut self, is_paused: bool) {
        if self.is_paused && !is_paused {
            self.next = Instant::now();
            self.made.clear();
            self.seats.iter_mut().for_each(|heard| heard.last = self.next);
        }
        self.is_paused = is_paused;
    }

    /// Whether the run is over.
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// How long until the next tick; none while time stands still.
    pub fn next_tick(&self, now: Instant) -> Option<Duration> {
        (!self.is_paused && !self.has_ended).then(|| self.next.saturating_duration_since(now))
    }

    /// Does what a page asks for.
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
                if let Some(heard) = self.seats.iter_mut().find(|heard| heard.seat == seat) {
                    (heard.last, heard.is_braked) = (Instant::now(), false);
                }
                self.session.wish(&seat, Wish { seq, acceleration, steering, assist })?;
            }
            PageMessage::Pause { paused } => {
                self.pause(paused);
                self.show(pages);
            }
            PageMessage::Rewind { seconds } => {
                self.session.rewind(seconds)?;
                (self.has_ended, self.ends_s, self.others) = (false, None, None);
                self.moment = StageWitness::standing(&self.session.states());
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
                (self.next, self.made) = (Instant::now(), Vec::new());
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
        self.brake_who_is_late(now)?;
        let Some(moment) = self.session.tick()? else {
            self.end(pages);
            return Ok(());
        };
        self.moment = moment;
        let step = Duration::from_secs_f64(self.session.written().step_s / self.rate);
        self.made.push(now);
        if self.made.len() > MEASURED {
            self.made.remove(0);
        }
        // No tick is left out: where the machine is too slow, time passes more slowly.
        self.next = (self.next + step).max(Instant::now());
        self.show(pages);
        // In a study every run is as long as that of a planner.
        if self.ends_s.is_none() && self.study.is_none() && self.session.is_decided() {
            let real = self.session.written().ego().map_or(1.0, |ego| ego.body.real_ratio().sqrt());
            self.ends_s = Some(self.session.time_s() + AFTER_S * real);
        }
        if self.ends_s.is_some_and(|ends_s| self.session.time_s() >= ends_s) || self.session.is_over() {
            self.end(pages);
        }
        Ok(())
    }

    fn brake_who_is_late(&mut self, now: Instant) -> Result<(), SessionError> {
        for heard in &mut self.seats {
            if !heard.is_braked && now.duration_since(heard.last) > LATE {
                heard.is_braked = true;
                self.session.wish(&heard.seat, RETREAT)?;
            }
        }
        Ok(())
    }

    /// Every page is told what is seen now.
    fn show(&self, pages: &[PageAtGame]) {
        for page in pages {
            page.send(&self.frame(page));
        }
    }

    /// What a page sees now.
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
            moment: Box::new(self.moment.clone()),
        }
    }

    /// How fast time has passed in the last ticks, as a share of how fast it should.
    fn dilation(&self) -> f64 {
        let (Some(first), Some(last)) = (self.made.first(), self.made.last()) else { return 1.0 };
        let wanted_s = (self.made.len() - 1) as f64 * self.session.written().step_s / self.rate;
        let took_s = last.duration_since(*first).as_secs_f64();
        if took_s > 0.0 && wanted_s > 0.0 { (wanted_s / took_s).min(1.0) } else { 1.0 }
    }

    /// The run is over: it is kept and scored, and planners drive from the same start.
    fn end(&mut self, pages: &[PageAtGame]) {
        if self.has_ended || self.session.ticks() == 0 {
            return;
        }
        self.has_ended = true;
        self.save();
        if self.study.is_some() {
            return;
        }
        self.tell_score(pages);
        let (requests, run) = (self.requests.clone(), self.run);
        let (written, seat): (Scenario, String) = (self.session.written().clone(), self.main_seat().to_owned());
        let duration_s = written.duration_s;
        std::thread::spawn(move || {
            let rows = others(&written, &seat, duration_s).unwrap_or_default();
            let _ = requests.send(Request::Others { run, rows });
        });
    }

    /// Tells every page how its seat has done.
    pub fn tell_score(&self, pages: &[PageAtGame]) {
        for page in pages {
            let mut score = self.session.score(self.seat_of(page));
            score.others = self.others.clone().unwrap_or_default();
            let saved = self.saved.as_ref().map(|(_, path)| path.display().to_string());
            let animation = Some(self.animation.clone());
            page.send(&ServerMessage::Score { score, saved, animation });
        }
    }

    /// Keeps what was played, unless nothing was since the last time.
    pub fn save(&mut self) {
        let ticks = self.session.ticks();
        if ticks == 0 || self.saved.as_ref().is_some_and(|(saved, _)| *saved == ticks) {
            return;
        }
        match crate::kept::keep(&self.session, &self.options.folder) {
            Ok(path) => self.saved = Some((ticks, path)),
            Err(error) => self.saved = self.saved.take().or(Some((ticks, PathBuf::from(format!("nowhere: {error}"))))),
        }
    }

    /// The scenario as it is written and as it was played, for a moving picture; none before the first tick.
    pub fn played(&self) -> Option<[Scenario; 2]> {
        (self.session.ticks() > 0).then(|| [self.session.written().clone(), self.session.played()])
    }
}
