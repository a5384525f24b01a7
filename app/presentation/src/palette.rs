//! Colours, shared by recordings, figures and animations so that a vehicle has the same colour in all of them.
//!
//! The colours of vehicles are those of Okabe and Ito, moved until every two of them, the asphalt and the colour of a failure
//! are at least 12 apart by CIEDE2000 (a test computes it) for people with full colour vision and for those who lack one kind of cone. They
//! are seen on white paper and on asphalt.

use interplay_scenarios::Scenario;
use interplay_simulation::frame::ZoneFrame;

/// A colour, red, green and blue.
pub type Colour = [u8; 3];

/// Least CIEDE2000 difference between colours that must be distinguishable with any kind of colour vision.
#[cfg(test)]
const MIN_COLOUR_DISTANCE: f64 = 12.0;

/// A colour with the word that a legend uses for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedColour {
    /// Red, green and blue.
    pub rgb: Colour,
    pub word: &'static str,
}

/// The ego.
pub const ORANGE: NamedColour = NamedColour { rgb: [0xE6, 0x9F, 0x00], word: "orange" };
/// The first of the other vehicles.
pub const BLUE: NamedColour = NamedColour { rgb: [0x04, 0x75, 0xF2], word: "blue" };
/// The second of the other vehicles.
pub const GREEN: NamedColour = NamedColour { rgb: [0x00, 0x84, 0x68], word: "green" };
/// The third of the other vehicles.
pub const PURPLE: NamedColour = NamedColour { rgb: [0xB4, 0x76, 0xA9], word: "purple" };
/// The fourth of the other vehicles.
pub const SKY: NamedColour = NamedColour { rgb: [0x7C, 0xB8, 0xEA], word: "sky blue" };
/// The fifth of the other vehicles.
pub const OLIVE: NamedColour = NamedColour { rgb: [0x9D, 0x9F, 0x71], word: "olive" };
/// Limits and failures, such as a fallback plan. No vehicle has this colour.
pub const VERMILLION: NamedColour = NamedColour { rgb: [0xD5, 0x5E, 0x00], word: "vermillion" };

/// The other vehicles in the scenario's order; the colours repeat after the last.
pub const OTHERS: [NamedColour; 5] = [BLUE, GREEN, PURPLE, SKY, OLIVE];

pub const OBSTACLE: NamedColour = NamedColour { rgb: [0x9A, 0x9E, 0xA4], word: "grey" };

/// A vehicle of a crowd that no picture names.
pub const UNNAMED: Colour = [0xC8, 0xCB, 0xCF];

/// The surface of footpaths.
pub const PATH: Colour = [0x8C, 0x8B, 0x86];
/// The surface of lanes that are reserved for some users.
pub const RESERVED_LANE: Colour = [0x6A, 0x4C, 0x45];
/// The surface of roads.
pub const ASPHALT: Colour = [0x4B, 0x4F, 0x56];
/// The strip of gravel beside a road.
pub const VERGE: Colour = [0xCD, 0xD3, 0xB8];
/// The stones between a road and its verge.
pub const KERB: Colour = [0x9A, 0x9C, 0x9A];
/// The ground beside the road.
pub const GRASS: Colour = [0xB9, 0xCB, 0xA4];
/// Lines on the road.
pub const PAINT: Colour = [0xEC, 0xEC, 0xE6];
/// Arrows on the road.
pub const ARROW: Colour = [0xB9, 0xBC, 0xBE];
pub const TYRE: Colour = [0x17, 0x18, 0x1A];
/// Windows.
pub const GLASS: Colour = [0x22, 0x2C, 0x38];
pub const HEADLIGHT: Colour = [0xFF, 0xF6, 0xD6];
pub const TAIL_LIGHT: Colour = [0x7A, 0x1A, 0x1C];
/// A lit brake light.
pub const BRAKE_LIGHT: Colour = [0xFF, 0x2A, 0x2A];
/// A lit indicator: further from the orange of the ego than real ones.
pub const INDICATOR: Colour = [0xFF, 0xE8, 0x3A];
/// The middle of the star that marks a contact.
pub const FLASH: Colour = [0xFF, 0xE3, 0x6B];

/// Distance from the wanted temperature at which the colour scale of rooms ends \[K\].
pub const COLOUR_RANGE_K: f64 = 5.0;

/// Colour between blue (cold), grey and red (warm), dark enough for white letters; `share` is from −1 to 1.
pub fn temperature_colour(share: f64) -> Colour {
    const COLD: [f64; 3] = [30.0, 90.0, 190.0];
    const MIDDLE: [f64; 3] = [95.0, 100.0, 95.0];
    const WARM: [f64; 3] = [200.0, 60.0, 20.0];
    let share = share.clamp(-1.0, 1.0);
    let end = if share < 0.0 { COLD } else { WARM };
    std::array::from_fn(|part| (MIDDLE[part] + share.abs() * (end[part] - MIDDLE[part])) as u8)
}

/// One colour a vehicle, in the scenario's order: orange for the ego.
pub fn vehicle_colours(scenario: &Scenario) -> Vec<NamedColour> {
    let ego = scenario.ego_index();
    let mut others = OTHERS.into_iter().cycle();
    (0..scenario.vehicles.len())
        .map(|index| match &scenario.vehicles[index].obstacle {
            _ if index == ego => ORANGE,
            Some(_) => OBSTACLE,
            None => others.next().unwrap_or(BLUE),
        })
        .collect()
}

/// A colour in the notation of CSS.
pub fn css([red, green, blue]: Colour) -> String {
    format!("#{red:02X}{green:02X}{blue:02X}")
}

/// A darker shade.
pub fn darker(colour: Colour) -> Colour {
    colour.map(|part| (f64::from(part) * 0.55) as u8)
}

/// The mean wanted temperature of each zone while it is occupied \[°C\].
pub fn usual_wanted_c(scenario: &Scenario, names: &[String]) -> Vec<f64> {
    let mean_c = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    let setpoints = scenario.setpoints.clone().unwrap_or_default();
    let of_all = |zone: usize| setpoints.occupied_c.get(zone.min(setpoints.occupied_c.len().saturating_sub(1)));
    let of_zone = |(zone, name): (usize, &String)| {
        let own = scenario.schedules.iter().filter(|schedule| schedule.zones.contains(name));
        let scheduled = mean_c(&mut own.flat_map(|schedule| &schedule.periods).map(|period| period.wanted_c));
        scheduled.or_else(|| of_all(zone).copied()).unwrap_or_default()
    };
    names.iter().enumerate().map(of_zone).collect()
}

/// The mean over the zones of their usual wanted temperature \[°C\].
pub fn middle_c(usual_c: &[f64]) -> f64 {
    usual_c.iter().sum::<f64>() / usual_c.len().max(1) as f64
}

/// The colour of a zone by its deviation from the wanted temperature, or from its usual one while none is wanted.
pub fn zone_colour(zone: &ZoneFrame, temperature_c: f64, usual_c: f64) -> Colour {
    deviation_colour(temperature_c - zone.reference_c.unwrap_or(usual_c))
}

/// The colour of a deviation from the wanted temperature \[K\].
pub fn deviation_colour(deviation_k: f64) -> Colour {
    temperature_colour(deviation_k / COLOUR_RANGE_K)
}

/// A number with one decimal, and with a minus sign instead of a hyphen.
pub fn one_decimal(value: f64) -> String {
    let rounded = (10.0 * value).round() / 10.0;
    let sign = if rounded < 0.0 { "−" } else { "" };
    format!("{sign}{:.1}", rounded.abs())
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    /// Linear red, green and blue as a colour-blind person sees them: Machado, Oliveira and Fernandes (2009), severity 1.
    const VISIONS: [(&str, [[f64; 3]; 3]); 4] = [
        ("full", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        (
            "protanopia",
            [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        ),
        (
            "deuteranopia",
            [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        ),
        (
            "tritanopia",
            [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
        ),
    ];

    /// The colour in CIELAB, white point D65.
    fn lab(colour: Colour, vision: &[[f64; 3]; 3]) -> [f64; 3] {
        let linear = colour.map(|part| {
            let part = f64::from(part) / 255.0;
            if part <= 0.04045 { part / 12.92 } else { libm::pow((part + 0.055) / 1.055, 2.4) }
        });
        let times = |matrix: &[[f64; 3]; 3], of: [f64; 3]| {
            [0, 1, 2].map(|row| (0..3).map(|column| matrix[row][column] * of[column]).sum::<f64>())
        };
        let seen = times(vision, linear).map(|part| part.clamp(0.0, 1.0));
        const XYZ: [[f64; 3]; 3] =
            [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]];
        let [x, y, z] = times(&XYZ, seen);
        let root = |t: f64| {
            if t > 216.0 / 24389.0 { libm::cbrt(t) } else { (24389.0 / 27.0 * t + 16.0) / 116.0 }
        };
        let [x, y, z] = [root(x / 0.95047), root(y), root(z / 1.08883)];
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// The difference of two colours by CIEDE2000 (Sharma, Wu and Dalal, 2005).
    fn ciede2000(one: [f64; 3], other: [f64; 3]) -> f64 {
        let chroma = |[_, a, b]: [f64; 3]| libm::hypot(a, b);
        let seventh = |c: f64| (libm::pow(c, 7.0) / (libm::pow(c, 7.0) + libm::pow(25.0, 7.0))).sqrt();
        let g = 0.5 * (1.0 - seventh(0.5 * (chroma(one) + chroma(other))));
        let polar = |[l, a, b]: [f64; 3]| {
            let a = (1.0 + g) * a;
            [l, libm::hypot(a, b), libm::atan2(b, a).to_degrees().rem_euclid(360.0)]
        };
        let ([l1, c1, h1], [l2, c2, h2]) = (polar(one), polar(other));
        let turn = (h2 - h1 + 180.0).rem_euclid(360.0) - 180.0;
        let (l, c, h) = (0.5 * (l1 + l2), 0.5 * (c1 + c2), (h1 + 0.5 * turn).rem_euclid(360.0));
        let cos = |degrees: f64| libm::cos(degrees.to_radians());
        let t =
            1.0 - 0.17 * cos(h - 30.0) + 0.24 * cos(2.0 * h) + 0.32 * cos(3.0 * h + 6.0) - 0.2 * cos(4.0 * h - 63.0);
        let off = (l - 50.0) * (l - 50.0);
        let lightness = (l2 - l1) / (1.0 + 0.015 * off / (20.0 + off).sqrt());
        let saturation = (c2 - c1) / (1.0 + 0.045 * c);
        let hue = 2.0 * (c1 * c2).sqrt() * libm::sin(0.5 * turn.to_radians()) / (1.0 + 0.015 * c * t);
        let bend = 30.0 * libm::exp(-((h - 275.0) / 25.0) * ((h - 275.0) / 25.0));
        let rotation = -libm::sin((2.0 * bend).to_radians()) * 2.0 * seventh(c);
        (lightness * lightness + saturation * saturation + hue * hue + rotation * saturation * hue).sqrt()
    }

    /// Pairs of the table that the authors of the formula publish for tests of it.
    #[test]
    fn ciede2000_reproduces_the_published_table() {
        let pairs = [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
            ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ];
        for (one, other, expected) in pairs {
            let found = ciede2000(one, other);
            assert!((found - expected).abs() < 1e-4, "{one:?} {other:?}: {found}");
        }
    }

    #[test]
    fn colours_are_distinguishable_with_any_kind_of_colour_vision() {
        let vehicles = [ORANGE, BLUE, GREEN, PURPLE, SKY, OLIVE].map(|colour| (colour.word, colour.rgb));
        let others = [("asphalt", ASPHALT), (VERMILLION.word, VERMILLION.rgb)];
        for (vision, matrix) in &VISIONS {
            for (index, (word, colour)) in vehicles.iter().enumerate() {
                for (other_word, other) in vehicles[..index].iter().chain(&others) {
                    let found = ciede2000(lab(*colour, matrix), lab(*other, matrix));
                    assert!(found >= MIN_COLOUR_DISTANCE, "{vision}: {word} and {other_word}: {found:.1}");
                }
            }
        }
    }

    /// A lit indicator is distinguishable from every vehicle; its dark rim separates it from headlights.
    #[test]
    fn indicators_are_visible_on_every_vehicle() {
        for (vision, matrix) in &VISIONS {
            let apart = |one: Colour, other: Colour| ciede2000(lab(one, matrix), lab(other, matrix));
            for vehicle in [ORANGE, BLUE, GREEN, PURPLE, SKY, OLIVE] {
                let found = [apart(INDICATOR, vehicle.rgb), apart(TYRE, vehicle.rgb)];
                assert!(
                    found.iter().all(|found| *found >= MIN_COLOUR_DISTANCE),
                    "{vision}: {}: {found:?}",
                    vehicle.word
                );
            }
            let rim = [INDICATOR, HEADLIGHT].map(|light| apart(TYRE, light));
            assert!(rim.iter().all(|found| *found >= MIN_COLOUR_DISTANCE), "{vision}: {rim:?}");
        }
    }

    #[test]
    fn cold_is_blue_and_warm_is_red() {
        assert_eq!(temperature_colour(-1.0), [30, 90, 190]);
        assert_eq!(temperature_colour(0.0), [95, 100, 95]);
        assert_eq!(temperature_colour(7.0), [200, 60, 20]);
    }

    #[test]
    fn the_usual_temperature_is_the_mean_of_the_schedule() {
        let names = ["office", "flat"].map(str::to_owned);
        let scenario = load("building/office-and-flat", &[]).expect("embedded");
        let usual_c = usual_wanted_c(&scenario, &names);
        assert_eq!(usual_c[0], 21.0);
        assert!((20.0..=21.0).contains(&usual_c[1]), "{usual_c:?}");
    }

    #[test]
    fn room_colours_are_relative_to_the_wanted_or_usual_temperature() {
        let zone = |reference_c| ZoneFrame {
            temperature_c: 21.0,
            next_c: 21.0,
            reference_c,
            band_k: None,
            requested_kw: 0.0,
            heat_kw: 0.0,
            gains_kw: 0.0,
            sun_kw: 0.0,
            electric_kw: 0.0,
        };
        assert_eq!(zone_colour(&zone(Some(21.0)), 21.0, 25.0), deviation_colour(0.0));
        assert_eq!(zone_colour(&zone(None), 21.0, 25.0), deviation_colour(-4.0));
    }

    #[test]
    fn negative_numbers_have_a_minus_sign() {
        assert_eq!([-1.84, -0.04, 0.0, 3.06].map(one_decimal), ["−1.8", "0.0", "0.0", "3.1"]);
    }
}
