//! Which of the measured drivers a vehicle has whose style is `measured`: drawn from the seed of the scenario and the vehicle's name, so
//! that another vehicle in the file changes none of the draws.

use interplay_common::random::SplitMix64;
use interplay_planners::Driver;
use interplay_planners::drivers::human::Style;

use crate::model::scenario::Vehicle;

/// Writes into the settings of measured drivers which member of the population they are, if not stated.
pub(super) fn draw(vehicles: &mut [Vehicle], seed: u64) {
    for vehicle in vehicles {
        let Driver::Human(settings) = &mut vehicle.driver else { continue };
        if settings.style == Some(Style::Measured) && settings.member.is_none() {
            settings.member = Some(member(seed, &vehicle.name));
        }
    }
}

/// A number that depends on every letter of a name and on the seed.
fn member(seed: u64, name: &str) -> u32 {
    let mut mixed = SplitMix64::new(seed).next_u64();
    for byte in name.bytes() {
        mixed = SplitMix64::new(mixed ^ u64::from(byte)).next_u64();
    }
    // A number that a file can state.
    (mixed >> 33) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_depend_on_seed_and_name() {
        assert_eq!(member(1, "car-1"), member(1, "car-1"));
        assert!(member(1, "car-1") != member(2, "car-1") && member(1, "car-1") != member(1, "car-2"));
        assert!(i64::from(member(3, "x")) >= 0);
    }
}
