//! The content of recordings, and when their files are written.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use interplay_planners::drivers::negotiation::diagnostics::CONCESSION_WEIGHT;
use interplay_planners::plan::diagnostic::{COMMON_PANELS, COST, RUNNER_UP_COST};
use interplay_planners::{PassingSide, Plan, PlannedPassing, Proposal, State, Trajectory};
use interplay_scenarios::{Override, Registry, Scenario, load};
use interplay_simulation::frame::{Event, Level, Origin, VehicleFrame};
use rerun::log::LogMsg;

use super::*;

/// The folder of a test, removed when it is dropped.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(test: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("interplay-record-{}-{test}", std::process::id()));
        fs::create_dir_all(&path).expect("the temporary folder is writable");
        Folder(path)
    }

    /// The names in the folder, sorted.
    pub fn contents(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("it exists");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn scenario(planner: Option<&str>) -> Scenario {
    let changes: Vec<Override> = planner.map(|kind| Override::Planner(kind.to_owned())).into_iter().collect();
    load("lane-change/front-nice", &changes).expect("embedded")
}

/// All vehicles drive straight ahead; the ego makes a request of front during the first half.
fn frame(scenario: &Scenario, tick: usize) -> Frame {
    let vehicles = scenario.vehicles.iter().map(|vehicle| {
        let place = |t: usize| State { x_m: vehicle.start.x_m + 0.1 * t as f64, ..vehicle.start };
        let ahead = Trajectory { states: (0..=10).map(|t| place(tick + t)).collect(), inputs: Vec::new() };
        let asks = vehicle.driver.kind() == "negotiation" && tick < 5;
        let plan = Plan {
            trajectory: ahead.clone(),
            proposals: asks
                .then(|| Proposal { to: "front".to_owned(), trajectory: ahead.clone(), acceptance: Some(1.0) })
                .into_iter()
                .collect(),
            diagnostics: if asks { vec![CONCESSION_WEIGHT.is(0.5)] } else { vec![COST.is(1.0)] },
            homotopy_class: vec![PlannedPassing { of: "rear".to_owned(), side: PassingSide::Ahead }],
            ..Plan::default()
        };
        let origin = if tick == 7 { Origin::Braking } else { Origin::Planned };
        VehicleFrame {
            name: vehicle.name.clone(),
            state: place(tick),
            plan: plan.into(),
            origin,
            prediction: ahead.into(),
            ..Default::default()
        }
    });
    let warning = Event { vehicle: "ego".to_owned(), level: Level::Warning, text: "no plan".to_owned() };
    let events = if tick == 7 { vec![warning] } else { Vec::new() };
    Frame {
        tick,
        time_s: 0.1 * tick as f64,
        vehicles: vehicles.collect(),
        events,
        gap_m: Some(0.3),
        ..Frame::default()
    }
}

fn recorded(scenario: &Scenario, path: &Path) -> Recorder {
    let sink = Sink::File(path.to_owned());
    let mut recorder = Recorder::begin(scenario, "lane-change/front-nice", &sink).expect("writable");
    for tick in 0..10 {
        recorder.log_frame(&frame(scenario, tick)).expect("recorded");
    }
    recorder
}

/// The number of rows and the timelines of each entity.
fn entities(recorder: &mut Recorder) -> BTreeMap<String, (usize, Vec<String>)> {
    recorder.cameras.log_all(&recorder.stream, &recorder.scenario).expect("logged");
    recorder.send_layout().expect("arranged");
    let Output::File { content, .. } = &recorder.output else { panic!("a recording in memory") };
    let mut entities: BTreeMap<String, (usize, Vec<String>)> = BTreeMap::new();
    for message in content.take() {
        let LogMsg::ArrowMsg(_, chunk) = message else { continue };
        let schema = chunk.batch.schema();
        let entity = schema.metadata().get("rerun:entity_path").expect("every chunk belongs to an entity");
        let timeline = |metadata: &std::collections::HashMap<String, String>| metadata.get("rerun:index_name").cloned();
        let timelines: Vec<String> = schema.fields().iter().filter_map(|field| timeline(field.metadata())).collect();
        let known = entities.entry(entity.clone()).or_default();
        known.0 += if timelines.is_empty() { 0 } else { chunk.batch.num_rows() };
        known.1.extend(timelines);
    }
    entities
}

#[test]
fn a_recording_has_the_documented_entities_at_every_tick() {
    let folder = Folder::new("entities");
    let mut recorder = recorded(&scenario(None), &folder.0.join("run.rrd"));
    let entities = entities(&mut recorder);
    let rows = |path: &str| entities.get(path).unwrap_or_else(|| panic!("{path} in {:?}", entities.keys())).0;
    for vehicle in ["ego", "front", "rear"] {
        for part in ["body", "plan", "prediction"] {
            assert_eq!(rows(&format!("/world/vehicle/{vehicle}/{part}")), 10);
        }
        assert_eq!(rows(&format!("/world/camera/top/label/{vehicle}")), 10);
        assert_eq!(rows(&format!("/world/vehicle/{vehicle}/body/mesh")), 0, "static");
        assert_eq!(rows(&format!("/world/vehicle/{vehicle}/trace")), 9);
        for quantity in ["speed", "acceleration", "steering", "planner-ms"] {
            assert_eq!(rows(&format!("/plots/{quantity}/{vehicle}")), 10);
        }
    }
    assert_eq!(rows("/world/vehicle/front/safety"), 10);
    assert!(!entities.contains_key("/world/vehicle/ego/safety"));
    assert_eq!((rows("/world/camera/top"), rows("/world/camera/side")), (10, 10));
    assert!((2..10).contains(&rows("/status")), "where it changes");
    assert_eq!(rows("/world/vehicle/ego/proposal"), 6, "five proposals, and one row that takes the last away");
    assert_eq!(rows("/plots/negotiation/concession-weight"), 5);
    assert_eq!(rows("/plots/human/cost/rear"), 10, "two humans: the name tells them apart");
    assert_eq!(rows("/plots/gap"), 10);
    assert_eq!(rows("/log"), 3, "a fallback is logged once: by the event, or else by the recorder");
    for path in ["/about", "/world/road/surface", "/world/road/edges", "/world/road/markings"] {
        assert_eq!(rows(path), 0, "static");
    }
}

#[test]
fn markings_are_drawn_only_between_lanes() {
    let folder = Folder::new("crossing");
    let crossing = load("intersection/nice", &[]).expect("embedded");
    let drawn = |scenario: &Scenario| {
        let entities = entities(&mut recorded(scenario, &folder.0.join("run.rrd")));
        entities.keys().filter(|path| path.starts_with("/world/road/")).count()
    };
    assert_eq!(drawn(&crossing), 2, "surface, edges");
    assert_eq!(drawn(&scenario(None)), 3, "and markings between lanes");
}

#[test]
fn recordings_contain_no_wall_clock_times() {
    let folder = Folder::new("clock");
    let mut recorder = recorded(&scenario(None), &folder.0.join("run.rrd"));
    for (path, (_, timelines)) in entities(&mut recorder) {
        assert!(
            timelines.iter().all(|name| [SIM_TIME, TICK, building::ITERATION, "blueprint"].contains(&name.as_str())),
            "{path}: {timelines:?}"
        );
    }
}

#[test]
fn the_layout_has_no_empty_panels() {
    let folder = Folder::new("panels");
    let views = |planner| {
        let mut recorder = recorded(&scenario(planner), &folder.0.join("run.rrd"));
        let is_view = |path: &&String| path.starts_with("/view/") && path.ends_with("/ViewContents");
        let panel = LayoutNode::Tabs(layout::tabs(&recorder.scenario, &recorder.plots, &recorder.cameras));
        (entities(&mut recorder).keys().filter(is_view).count(), titles(&panel))
    };
    let (count, shown) = views(None);
    assert_eq!(count, shown.len());
    assert!(shown.iter().any(|title| title.starts_with("Negotiation")), "{shown:?}");
    let (_, shown) = views(Some("conservative"));
    assert!(!shown.iter().any(|title| title.starts_with("Negotiation")), "{shown:?}");
    let nothing = Recorder::begin(&scenario(None), "x", &Sink::File(folder.0.join("x.rrd"))).expect("writable");
    let tabs = layout::tabs(&nothing.scenario, &nothing.plots, &nothing.cameras);
    let shown = titles(&LayoutNode::Tabs(tabs));
    assert!(!shown.iter().any(|title| title == "What happens" || title.starts_with("Gap")), "{shown:?}");
}

/// Collects the names of the diagnostics of the ego's planner.
struct DiagnosticNames(Arc<std::sync::Mutex<std::collections::BTreeSet<&'static str>>>);

impl Watcher for DiagnosticNames {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        let mut heard = self.0.lock().map_err(|error| error.to_string())?;
        heard.extend(frame.vehicles[0].plan.diagnostics.iter().map(|diagnostic| diagnostic.quantity.name));
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}

/// Otherwise a panel would be missing without a notice.
#[test]
fn planners_report_every_quantity_of_their_panels() {
    // Drivers with input from outside, and those of pedestrians, are left out.
    let planning = Registry::standard()
        .driver_kinds()
        .into_iter()
        .filter(|kind| !["external", "inputs", "recorded", "walker"].contains(kind));
    for kind in planning {
        let mut scenario = scenario(Some(kind));
        scenario.duration_s = 0.5;
        let heard = Arc::default();
        let watcher = DiagnosticNames(Arc::clone(&heard));
        interplay_simulation::run::run(kind, &scenario, vec![Box::new(watcher)]).expect("half a second");
        let heard = heard.lock().expect("no panic");
        let driver = &scenario.vehicles[0].driver;
        // Drivers that stand for humans do not report what holds their plans back.
        let common = if driver.goes_first() { &[] } else { COMMON_PANELS };
        let shown = driver.explanation().panels.iter().chain(common).flat_map(|panel| panel.quantities);
        // A runner-up exists only if a passing order had an alternative.
        for quantity in shown.filter(|quantity| **quantity != RUNNER_UP_COST) {
            assert!(heard.contains(quantity.name), "{kind} does not report `{}`: {heard:?}", quantity.name);
        }
    }
}

fn titles(panel: &LayoutNode) -> Vec<String> {
    match panel {
        LayoutNode::Row(parts) | LayoutNode::Column(parts) => parts.iter().flat_map(|(_, part)| titles(part)).collect(),
        LayoutNode::Tabs(parts) => parts.iter().flat_map(|(_, part)| titles(part)).collect(),
        LayoutNode::View(view) => vec![view.title().to_owned()],
    }
}

#[test]
fn a_building_recording_has_floor_plan_plots_and_day_timeline() {
    use interplay_simulation::frame::{BuildingFrame, ZoneFrame};
    let folder = Folder::new("building");
    let scenario = load("building/hundred-zones", &[]).expect("embedded");
    let sink = Sink::File(folder.0.join("run.rrd"));
    let mut recorder = Recorder::begin(&scenario, "building/hundred-zones", &sink).expect("writable");
    for tick in 0..3 {
        let zone = ZoneFrame {
            temperature_c: 24.0 + tick as f64,
            next_c: 25.0 + tick as f64,
            reference_c: (tick == 1).then_some(25.0),
            band_k: None,
            requested_kw: 0.0,
            heat_kw: 0.0,
            ..ZoneFrame::default()
        };
        let (ambient_c, forecast_c) = (30.0, 31.0);
        let building = BuildingFrame {
            day: tick,
            step: 0,
            zones: vec![zone; 100],
            ambient_c,
            forecast_c,
            ..BuildingFrame::default()
        };
        let frame = Frame { tick, time_s: 1800.0 * tick as f64, building: Some(building), ..Frame::default() };
        recorder.log_frame(&frame).expect("recorded");
    }
    let entities = entities(&mut recorder);
    let rows = |path: &str| entities.get(path).map_or(0, |(rows, _)| *rows);
    assert_eq!((rows("/building/plan/rooms"), rows("/building/zone/100/temperature")), (3, 3));
    assert_eq!(rows("/building/zone/1/reference"), 2, "one value, and its end");
    assert_eq!(rows("/building/zone/2/temperature"), 0, "it is in a group");
    assert_eq!((rows("/building/group/1"), rows("/building/group/10"), rows("/building/group/11")), (3, 3, 0));
    let (_, timelines) = &entities["/building/outdoors/real"];
    assert!([SIM_TIME, TICK, building::ITERATION].iter().all(|name| timelines.iter().any(|there| there == name)));
    assert!(!entities.keys().any(|path| path.starts_with("/world")), "no road without vehicles");
    let building_layer = recorder.building_layer.as_ref().expect("a building");
    let shown = |words| titles(&LayoutNode::Tabs(building::tabs(building_layer, words)));
    assert_eq!(
        shown(building::TextPanels::About).len(),
        1 + 4 + 4 + 10,
        "plan, temperatures, numbers, words, every zone"
    );
    assert_eq!(shown(building::TextPanels::None).len(), 1 + 4 + 3 + 10, "vehicles have the words");
}

#[test]
fn a_recording_file_appears_only_when_the_recording_is_finished() {
    let folder = Folder::new("finish");
    let path = folder.0.join("deep/run.rrd");
    drop(recorded(&scenario(None), &path));
    assert_eq!(folder.contents(), Vec::<String>::new());
    let recorder = recorded(&scenario(None), &path);
    assert_eq!(folder.contents(), Vec::<String>::new());
    recorder.finish().expect("written");
    assert_eq!(fs::read_dir(folder.0.join("deep")).expect("made").count(), 1);
    let content = fs::read(&path).expect("there");
    let footer = content.len() - 12;
    assert!(content.starts_with(b"RRF2") && content[footer..].starts_with(b"RRF2FOOT"), "begun and ended");
}

#[test]
fn an_unwritable_path_is_refused_before_the_run() {
    let folder = Folder::new("refused");
    let outcome = Recorder::begin(&scenario(None), "x", &Sink::File(folder.0.clone()));
    assert!(matches!(outcome, Err(RecordError::Unwritable { .. })));
    assert_eq!(folder.contents(), Vec::<String>::new());
}

#[test]
fn every_vehicle_up_to_six_has_a_colour_of_its_own() {
    let mut scenario = scenario(None);
    for copy in 0..3 {
        scenario
            .vehicles
            .push(interplay_scenarios::Vehicle { name: format!("more-{copy}"), ..scenario.vehicles[1].clone() });
    }
    let vehicle_colours = palette::vehicle_colours(&scenario);
    let words: std::collections::BTreeSet<&str> =
        vehicle_colours.iter().map(|vehicle_colour| vehicle_colour.word).collect();
    assert_eq!((vehicle_colours.len(), words.len(), vehicle_colours[0].word), (6, 6, "orange"));
}

/// The outcomes of counterfactuals are known after the run, so the recording stays open until then.
#[test]
fn an_open_recording_is_written_when_it_is_closed() {
    let folder = Folder::new("open");
    let path = folder.0.join("run.rrd");
    let scenario = load("intersection/nice", &[]).expect("embedded");
    let recorder = || Recorder::begin(&scenario, "nice", &Sink::File(path.clone())).expect("writable");
    let recording = OpenRecording::new(recorder());
    let watchers: Vec<Box<dyn Watcher>> = vec![Box::new(recording.clone())];
    let report = interplay_simulation::run::run("nice", &scenario, watchers).expect("a run");
    assert!(!path.exists(), "the run is over, and the recording is not");
    recording.close(&report).expect("writable");
    assert!(fs::read(&path).expect("there").starts_with(&MAGIC));
    fs::remove_file(&path).expect("there");
    drop(OpenRecording::new(recorder()));
    assert!(!path.exists(), "dropped unfinished, it leaves no file");
}
