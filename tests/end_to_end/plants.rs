//! Runs whose plant is not the planners' model: the table in `docs/theory/dynamic-plant.md`.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs};

use interplay_scenarios::{Plant, embedded};
use interplay_simulation::report::Report;
use rayon::prelude::*;

use crate::film::{FILMS, Film, authored, film};

const DYNAMIC: &str = "plant.kind=\"dynamic\"";
const MARKS: [&str; 2] = ["<!-- figures -->\n", "<!-- end of figures -->\n"];
/// How far a corner may be beside the road \[m\].
const ASTRAY_M: f64 = 0.06;
/// How a difference is dealt with.
const ADVICE: &str = "if the change is meant: INTERPLAY_BLESS=1 cargo test --release -p interplay-tests plants";
/// Of sixteen figures, how many keep their outcome.
const KEPT_OF_16: usize = 14;

/// The figure scenarios as they are filmed, each with a run on tyres; in the order of their names.
fn figures() -> Vec<(&'static Film, Film)> {
    let pairs = FILMS.iter().filter(|film| {
        let is_authored = embedded().iter().any(|file| file.name == film.name());
        is_authored && film.scenario.figure.is_some() && matches!(film.scenario.plant, Plant::Kinematic(_))
    });
    let pairs: Vec<&Film> = pairs.collect();
    let on_tyres = |own: &'static Film| (own, film(own.name(), authored(own.name(), &[DYNAMIC])));
    let mut done: Vec<_> = pairs.into_par_iter().map(on_tyres).collect();
    done.sort_by_key(|(own, _)| own.name());
    done
}

fn is_kept(own: &Report, tyres: &Report) -> bool {
    own.order == tyres.order && tyres.collisions.is_empty()
}

fn row((own, tyres): &(&Film, Film)) -> String {
    let (name, figure, ego) = (own.name(), own.scenario.figure.as_deref().unwrap_or("-"), own.scenario.ego_index());
    let (own, tyres) = (&own.report, &tyres.report);
    let kept = if is_kept(own, tyres) { "yes" } else { "**no**" };
    let order = if own.order == tyres.order {
        own.order.join(", ")
    } else {
        format!("{}; then {}", own.order.join(", "), tyres.order.join(", "))
    };
    let centimetres = |report: &Report| format!("{:.1}", 100.0 * report.min_gap_m().unwrap_or(f64::NAN));
    let time = |report: &Report| report.vehicles[ego].completed_s.map_or("-".to_owned(), |time| format!("{time:.1}"));
    let failed = tyres.expectations.iter().filter(|one| !one.passed && one.what != "order");
    let failed: Vec<String> = failed.map(|one| format!("`{}`", one.what)).collect();
    format!(
        "| `{name}` | {figure} | {kept} | {order} | {}, {} | {}, {} | {} |",
        time(own),
        time(tyres),
        centimetres(own),
        centimetres(tyres),
        failed.join(", ")
    )
}

fn table(figures: &[(&Film, Film)]) -> String {
    let kept = figures.iter().filter(|(own, tyres)| is_kept(&own.report, &tyres.report)).count();
    let mut table = format!(
        "{kept} of {} are kept. Pairs of numbers: with its own plant, with the dynamic one.\n\n\
         | scenario | figure | kept | order | the ego is there \\[s\\] | smallest gap \\[cm\\] | besides |\n\
         |---|---|---|---|---|---|---|\n",
        figures.len()
    );
    for pair in figures {
        writeln!(table, "{}", row(pair)).expect("a text can grow");
    }
    table
}

#[test]
fn the_page_lists_figures_that_keep_their_outcome_with_tyre_dynamics() {
    let figures = figures();
    let kept = figures.iter().filter(|(own, tyres)| is_kept(&own.report, &tyres.report)).count();
    assert!(16 * kept >= KEPT_OF_16 * figures.len(), "only {kept} of {}", figures.len());
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../docs/theory/dynamic-plant.md");
    let page = fs::read_to_string(&path).expect("the page can be read");
    let (before, rest) = page.split_once(MARKS[0]).expect("the page marks where the table begins");
    let (found, after) = rest.split_once(MARKS[1]).expect("and where it ends");
    let wanted = table(&figures);
    if env::var_os("INTERPLAY_BLESS").is_some_and(|value| value == "1") {
        let page = format!("{before}{}{wanted}{}{after}", MARKS[0], MARKS[1]);
        return fs::write(path, page).expect("the page can be written");
    }
    assert!(found == wanted, "the page says\n{found}\nbut it is\n{wanted}\n{ADVICE}");
}

/// No vehicle leaves an endless road by more than a third of its width, even one that plans with another model and reaches the edge;
/// and inputs stay within the limits.
#[test]
fn vehicles_with_tyre_dynamics_stay_on_their_road() {
    for name in ["lane-change/front-nice", "intersection/tough", "lane-keeping/tough"] {
        let film = film(name, authored(name, &[DYNAMIC]));
        for frame in &film.frames {
            for (seen, vehicle) in frame.vehicles.iter().zip(&film.scenario.vehicles) {
                assert!(vehicle.route.contains(&vehicle.body, &seen.state, ASTRAY_M), "{name}: {:?}", seen.state);
                assert!(seen.input.steering_rad.abs() <= vehicle.limits.steering_max_rad, "{name}: {:?}", seen.input);
            }
        }
    }
}

/// After the crash both brake to a standstill and do not negotiate, and the vehicle behind does not touch them.
#[test]
fn crashed_vehicles_come_to_rest() {
    let film = FILMS.iter().find(|film| film.name() == "crash/side-impact").expect("it is embedded");
    let crash = film.report.collisions.first().expect("a crash on purpose");
    assert!(crash.impulse_ns > 1.0 && crash.between == ["ego", "crossing"], "{crash:?}");
    let last = film.frames.last().expect("there are frames");
    for vehicle in &last.vehicles[..2] {
        assert!(vehicle.state.speed_mps.abs() < 1e-3, "{}: {:?}", vehicle.name, vehicle.state);
    }
    let pushed_m = last.vehicles[0].state.y_m - film.scenario.vehicles[0].start.y_m;
    assert!(pushed_m > 0.03, "pushed aside by {pushed_m} m");
    let impulses = film.report.collisions.iter().filter(|one| one.between.contains(&"follower".to_owned()));
    assert_eq!(impulses.count(), 0);
}
