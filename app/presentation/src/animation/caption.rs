//! The words below a picture: the request of the ego with its answer, or a collision, and the last event.

use interplay_planners::{PlanEventKind, PlannedPassing};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Event, Frame, Level};
use interplay_simulation::standing::Standing;

use super::camera::{CameraView, WIDTH_PX};
use super::canvas::{Align, Canvas, Ink};
use super::letters::{cut, width_of};
use super::scene::DrivingRun;
use crate::edge_mark::EdgeMark;
use crate::palette::Colour;
use crate::passing_words::{event_text, has_passed_oncoming, passing_sentence, vehicle_indices};
use crate::rectangle::{Rectangle, overlap};

/// Times that a collision and any other event stay in the caption \[s\], at 1/10 scale.
const COLLISION_SHOWN_S: f64 = 3.0;
const EVENT_SHOWN_S: f64 = 1.2;
/// Time that the place of a contact is marked \[s\], at 1/10 scale.
const CONTACT_SHOWN_S: f64 = 0.35;

/// The two lines below a picture: a negotiation or a collision, and the last event.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Caption {
    /// The request with its answer, the intended passings, or the collision.
    pub first: String,
    pub second: String,
    /// Whether the first line reports a collision.
    pub alarms: bool,
}

impl Caption {
    /// Indices of the vehicles that the caption mentions.
    pub fn mentioned(&self, scenario: &Scenario) -> Vec<usize> {
        let words = || [&self.first, &self.second].into_iter().flat_map(|line| line.split([' ', ',']));
        words().filter_map(|word| scenario.index_of(word)).collect()
    }
}

pub fn caption(run: &DrivingRun, time_s: f64) -> Caption {
    let ratio = run.scenario.ego().map_or(1.0, |ego| ego.body.time_ratio());
    let frame = run.frame(time_s);
    let past = |shown_s: f64| {
        let shown = move |frame: &&Frame| frame.time_s <= time_s + 1e-9 && frame.time_s > time_s - shown_s * ratio;
        run.frames.iter().copied().filter(shown).collect::<Vec<&Frame>>()
    };
    let hit = past(COLLISION_SHOWN_S).into_iter().flat_map(|frame| &frame.collisions).find(|hit| hit.time_s <= time_s);
    // The last event of the ego or, without one, of another vehicle.
    let recent = past(EVENT_SHOWN_S);
    let last = |is_of: &dyn Fn(bool) -> bool| recent.iter().rev().find_map(|frame| reportable_event(run, frame, is_of));
    let second = last(&|is_ego| is_ego).or_else(|| last(&|is_ego| !is_ego)).unwrap_or_default();
    if let Some(hit) = hit {
        let [one, other] = &hit.between;
        return Caption { first: format!("{one} and {other} collide"), second, alarms: true };
    }
    let is_told = !run.scenario.is_flow_alone();
    let first = is_told.then(|| request(run, frame).or_else(|| intention(run, frame))).flatten().unwrap_or_default();
    // An event that the first line already contains is left out.
    let words: Vec<&str> = first.split([' ', ',']).collect();
    let is_in_first = |does: &str| does.split(' ').all(|word| words.contains(&word));
    let said = second.split_once(' ').is_some_and(|(name, does)| first.starts_with(name) && is_in_first(does));
    let second = if said { String::new() } else { second };
    Caption { first, second, alarms: false }
}

/// The index pairs of the vehicles whose contact began recently.
pub fn contacts(run: &DrivingRun, time_s: f64) -> Vec<[usize; 2]> {
    let ratio = run.scenario.ego().map_or(1.0, |ego| ego.body.time_ratio());
    let hits = run.frames.iter().flat_map(|frame| &frame.collisions);
    let recent = hits.filter(|hit| hit.time_s <= time_s && time_s < hit.time_s + CONTACT_SHOWN_S * ratio);
    recent.filter_map(|hit| vehicle_indices(run.scenario, &hit.between)).collect()
}

/// The request of the ego, or else of another vehicle, with its answer. Expectations of other vehicles are left out.
fn request(run: &DrivingRun, frame: &Frame) -> Option<String> {
    let ego = run.scenario.ego_index();
    let mut vehicles: Vec<usize> = (0..frame.vehicles.len()).collect();
    vehicles.sort_by_key(|index| *index != ego);
    let requests = run.requests(frame);
    let asks = |vehicle: usize| {
        let sentence = requests.sentence(frame, vehicle)?;
        (vehicle == ego || sentence.starts_with("asks")).then_some((vehicle, sentence))
    };
    let (vehicle, sentence) = vehicles.into_iter().find_map(asks)?;
    Some(format!("{} {}", frame.vehicles[vehicle].name, sentence))
}

/// How the ego plans to pass the other vehicles, or why it stands by the rules of the road.
fn intention(run: &DrivingRun, frame: &Frame) -> Option<String> {
    let index = run.scenario.ego_index();
    let ego = &frame.vehicles[index];
    let standing = Standing::of(&run.scenario.vehicles, frame);
    if let Some(reason) = standing.reason(index).filter(|_| ego.rules.are_kept && standing.stands(index)) {
        return Some(format!("{} {reason}", ego.name));
    }
    // Vehicles that are passed in the same way share one verb.
    let mut passings: Vec<(String, Vec<&str>)> = Vec::new();
    let is_open = |passing: &&PlannedPassing| {
        run.is_named(frame, &passing.of) && !has_passed_oncoming(run.scenario, frame, index, passing)
    };
    for passing in ego.plan.homotopy_class.iter().filter(is_open) {
        let Some(sentence) = passing_sentence(run.scenario, index, passing) else { continue };
        let verb = sentence.strip_suffix(&passing.of).unwrap_or(&sentence);
        match passings.iter_mut().find(|(known, _)| known == verb) {
            Some((_, names)) => names.push(&passing.of),
            None => passings.push((verb.to_owned(), vec![&passing.of])),
        }
    }
    let said: Vec<String> = passings.iter().map(|(verb, names)| format!("{verb}{}", names.join(" and "))).collect();
    (!said.is_empty()).then(|| format!("{} {}", ego.name, said.join(", ")))
}

/// The event of a tick to report, of the ego or of others: warnings before notes.
fn reportable_event(run: &DrivingRun, frame: &Frame, is_of: &dyn Fn(bool) -> bool) -> Option<String> {
    let ego = run.scenario.ego().map(|ego| ego.name.as_str());
    let of_level = |level: Level| {
        // The end of a request is not reported, and the ego's request is already in the first line.
        let is_news = |event: &&Event| {
            let is_wanted = event.level == level && is_of(Some(event.vehicle.as_str()) == ego);
            is_wanted && !is_change_of_partner(frame, event) && run.is_named(frame, &event.vehicle)
        };
        let said = |event: &Event| {
            event_text(run.scenario, frame, event).map(|text| format!("{} {}", event.vehicle, plain(&text)))
        };
        frame.events.iter().filter(is_news).find_map(said)
    };
    // Collisions are already in the first line.
    of_level(Level::Warning).or_else(|| of_level(Level::Note))
}

/// Whether an event is that a planner asks another vehicle, or none any more.
fn is_change_of_partner(frame: &Frame, event: &Event) -> bool {
    let vehicle = frame.vehicles.iter().find(|vehicle| vehicle.name == event.vehicle);
    let mut planned = vehicle.into_iter().flat_map(|vehicle| &vehicle.plan.events);
    planned.any(|planned| planned.text == event.text && matches!(planned.kind, PlanEventKind::Partner(_)))
}

/// Removes the text in brackets, where planners give reasons in the terms of their optimisers.
fn plain(words: &str) -> String {
    match (words.find(" ("), words.rfind(')')) {
        (Some(from), Some(to)) if from < to => format!("{}{}", &words[..from], &words[to + 1..]),
        _ => words.to_owned(),
    }
}

/// Colours of the bars above and below, and of the words on them.
pub const BAR: Colour = [0x23, 0x26, 0x2B];
pub const WORDS: Colour = [0xF2, 0xF2, 0xEE];
/// Height of the bar above \[px\].
pub const TITLE_PX: f64 = 30.0;
/// Size of words \[px\].
pub const TEXT_PX: f64 = 16.0;
/// Space beside words \[px\].
pub const MARGIN_PX: f64 = 12.0;

/// Draws the title bar; the title is cut at `longest_px`.
pub fn draw_title(canvas: &mut Canvas, title: &str, longest_px: f64, clock: &str) {
    canvas.block([0.0, 0.0], [WIDTH_PX, TITLE_PX], BAR);
    let y = 0.5 * TITLE_PX;
    canvas.text([WIDTH_PX - MARGIN_PX, y], Align::Right, TEXT_PX, clock, WORDS);
    canvas.text([MARGIN_PX, y], Align::Left, TEXT_PX, &cut(title, TEXT_PX, longest_px), WORDS);
}

/// Length of an arrow and size of its words \[px\].
const ARROW_PX: f64 = 16.0;
const LABEL_PX: f64 = 14.0;
/// Space between an arrow and its words \[px\].
const BETWEEN_PX: f64 = 6.0;

/// Draws a mark in the colour of its vehicle, with words that avoid the `taken` rectangles if possible. Returns the rectangle of
/// the words.
pub fn draw_edge_mark(
    canvas: &mut Canvas,
    view: &CameraView,
    mark: &EdgeMark,
    colour: Colour,
    taken: &[Rectangle],
) -> Rectangle {
    let [dx, dy] = mark.toward;
    let point = |ahead: f64, left: f64| [mark.at[0] + ahead * dx - left * dy, mark.at[1] + ahead * dy + left * dx];
    let arrow = |half: f64| [point(half, 0.0), point(-half, 0.85 * half), point(-half, -0.85 * half)];
    canvas.fill(&arrow(0.5 * ARROW_PX + 3.0), WORDS);
    canvas.fill(&arrow(0.5 * ARROW_PX), colour);
    let (wide, high) = (width_of(&mark.words, LABEL_PX) + 10.0, LABEL_PX + 4.0);
    let away = 0.5 * ARROW_PX + BETWEEN_PX;
    let middle = [mark.at[0] - dx * (away + 0.5 * wide), mark.at[1] - dy * (away + 0.5 * high)];
    let half = [0.5 * wide + 2.0, 0.5 * high + 2.0];
    // The label lies between the arrow and the middle of the view or, if that is taken, above or below.
    let place = |beside: f64| {
        let wanted = [middle[0], middle[1] + beside * (high + 8.0)];
        let inside = |axis: usize| wanted[axis].clamp(half[axis], (view.size_px[axis] - half[axis]).max(half[axis]));
        let [x, y] = [inside(0), inside(1)];
        [x - 0.5 * wide, y - 0.5 * high, x + 0.5 * wide, y + 0.5 * high]
    };
    let is_free = |place: &Rectangle| !taken.iter().any(|other| overlap(*place, *other));
    let places = [0.0, -1.0, 1.0, -2.0, 2.0].map(place);
    let [l, t, r, b] = places.into_iter().find(is_free).unwrap_or(places[0]);
    canvas.fill_rounded(&[[l, t], [r, t], [r, b], [l, b]], 5.0, Ink::translucent(BAR, 0.82));
    canvas.text([0.5 * (l + r), 0.5 * (t + b)], Align::Middle, LABEL_PX, &mark.words, WORDS);
    [l, t, r, b]
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::figures::RecordedRun;

    fn captions(name: &str) -> Vec<Caption> {
        let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        let run = DrivingRun::from_run(&recorded).expect("vehicles");
        run.frames.iter().map(|frame| caption(&run, frame.time_s)).collect()
    }

    #[test]
    fn the_caption_has_the_request_and_its_answer() {
        let captions = captions("intersection/nice");
        assert!(
            captions
                .iter()
                .any(|caption| caption.first.starts_with("ego asks crossing") && caption.first.contains("accepts"))
        );
        assert!(captions.iter().any(|caption| !caption.second.is_empty()));
        assert!(captions.iter().all(|caption| !caption.alarms));
    }

    #[test]
    fn the_caption_reports_a_collision() {
        let captions = captions("crash/side-impact");
        let alarms = captions.iter().filter(|caption| caption.alarms).count();
        assert!(alarms > 5 && alarms < captions.len());
        let said = captions.iter().find(|caption| caption.alarms).expect("a collision");
        assert!(said.first.contains("ego") && said.first.contains("crossing"), "{}", said.first);
    }

    /// Captions contain no terms of optimisers, and no sides where routes turn.
    #[test]
    fn captions_contain_no_jargon() {
        let words = |name: &str| captions(name).into_iter().flat_map(|caption| [caption.first, caption.second]);
        for name in ["ramp-merge/front-tough", "narrow-passage/two-negotiators", "left-turn/nice"] {
            assert!(words(name).all(|words| !words.contains("residual") && !words.contains("iterations")), "{name}");
        }
        assert!(words("roundabout/nice").all(|words| !words.contains("right of") && !words.contains("left of")));
        assert_eq!(plain("no plan (infeasible: (6.2) is); brakes"), "no plan; brakes");
    }
}
