//! Tables of what the houses of a world showed.

use interplay_building::identify::{Confidence, SuspectedCause};

use super::heater::Way;
use super::world::World;
use super::{HouseOutcome, Outcome};

/// An estimate further from the truth than this share of it is off.
const OFF: f64 = 0.25;

/// The cause that should be named first in a world; `None` in the right world, and where no cause can be seen.
fn right_cause(world: World) -> Option<SuspectedCause> {
    match world {
        World::Windows => Some(SuspectedCause::Windows),
        World::SunFromAnotherSide => Some(SuspectedCause::Sun),
        World::Clock => Some(SuspectedCause::Clock),
        World::People => Some(SuspectedCause::People),
        World::LateHeat => Some(SuspectedCause::LateHeat),
        World::Electricity => Some(SuspectedCause::VaryingGain),
        World::Matched | World::Quantised | World::ColouredHeat | World::Meter => None,
    }
}

pub(super) fn print(name: &str, world: World, houses: &[HouseOutcome]) {
    let states: Vec<usize> =
        (1..=3).map(|states| houses.iter().filter(|house| house.states == states).count()).collect();
    let sunlit = houses.iter().filter(|house| house.sunlit).count();
    println!("{name}: {} houses; 1, 2, 3 states chosen {states:?}, sun on a mass in {sunlit}", houses.len());
    let warned = houses.iter().filter(|house| !house.causes.is_empty()).count();
    let first = |cause| houses.iter().filter(|house| house.causes.first() == Some(&cause)).count();
    let named: usize = houses.iter().map(|house| house.causes.len()).sum();
    print!("  warned of a wrong world {warned}, {named} causes named; first:");
    use SuspectedCause::{Clock, Halves, LateHeat, People, Sun, VaryingGain, Windows};
    for cause in [Clock, Sun, People, Windows, LateHeat, VaryingGain, Halves] {
        print!(" {cause:?} {}", first(cause));
    }
    println!();
    if let Some(right) = right_cause(world) {
        let anywhere = houses.iter().filter(|house| house.causes.contains(&right)).count();
        println!("  right cause first in {}, named in {anywhere} of {}", first(right), houses.len());
    } else {
        for way in [Way::Thermostat, Way::Proportional, Way::Steps, Way::Modulating] {
            let of = || houses.iter().filter(move |house| house.way == way);
            print!("  {way:?}: {} of {} warned;", of().filter(|house| !house.causes.is_empty()).count(), of().count());
        }
        println!();
    }
    for quantity in ["heat capacity", "conductance to outdoor", "aperture to the sun"] {
        print_quantity(quantity, houses);
    }
}

fn holds(it: &Outcome) -> bool {
    it.interval.0.is_none_or(|low| low <= it.truth) && it.interval.1.is_none_or(|high| it.truth <= high)
}

/// ln of the ratio of the ends of an interval.
fn width(it: &Outcome) -> Option<f64> {
    Some(libm::log(it.interval.1? / it.interval.0?))
}

fn print_quantity(quantity: &str, houses: &[HouseOutcome]) {
    let of = |all: fn(&HouseOutcome) -> &Vec<Outcome>| -> Vec<&Outcome> {
        houses.iter().flat_map(all).filter(|it| it.quantity == quantity).collect()
    };
    let found = of(|house| &house.quantities);
    let is_bounded = |it: &&&Outcome| it.interval.0.is_some() || it.interval.1.is_some();
    let bounded: Vec<&&Outcome> = found.iter().filter(is_bounded).collect();
    let covered = bounded.iter().filter(|it| holds(it)).count();
    let identified: Vec<&&Outcome> = found.iter().filter(|it| it.confidence == Confidence::Identified).collect();
    let is_off = |it: &Outcome| it.value.is_none_or(|value| (value / it.truth - 1.0).abs() > OFF);
    let wrong = identified.iter().filter(|it| is_off(it)).count();
    let outside = identified.iter().filter(|it| !holds(it)).count();
    let errors = found.iter().filter_map(|it| Some((it.value? / it.truth - 1.0).abs()));
    println!(
        "  {quantity:24} {covered} of {} intervals hold the truth; {} identified, of them {wrong} off by more than 25 %, {outside} \
         outside of their interval; largest error {:.0} %",
        bounded.len(),
        identified.len(),
        100.0 * errors.fold(0.0, f64::max)
    );
    let ratio = |house: &HouseOutcome| {
        let width = |all: &[Outcome]| width(all.iter().find(|it| it.quantity == quantity)?);
        Some(width(&house.quantities)? / width(&house.held)?)
    };
    let mut ratios: Vec<f64> = houses.iter().filter_map(ratio).collect();
    ratios.sort_by(f64::total_cmp);
    if let Some(median) = ratios.get(ratios.len() / 2) {
        let held = of(|house| &house.held);
        let known = held.iter().filter(|it| it.confidence == Confidence::Identified).count();
        println!("  {:24} with heat held: {known} identified; median width over that with heat held {median:.2}", "");
    }
}
