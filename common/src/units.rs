//! The unit of a setting, read from the end of its key: `speed_mps` is in m/s.
//!
//! A number whose key does not end with a unit states one on its field: `#[schemars(extend("x-unit" = "1/m²"))]`, or
//! `"dimensionless"`. Whole numbers are counts and have no unit.

/// Endings of keys, and the units that they stand for.
const ENDINGS: [(&str, &str); 23] = [
    ("m", "m"),
    ("m2", "m²"),
    ("s", "s"),
    ("ms", "ms"),
    ("h", "h"),
    ("days", "days"),
    ("deg", "deg"),
    ("rad", "rad"),
    ("per_rad", "1/rad"),
    ("radps", "rad/s"),
    ("mps", "m/s"),
    ("mps2", "m/s²"),
    ("mps3", "m/s³"),
    ("c", "°C"),
    ("k", "K"),
    ("kw", "kW"),
    ("kwh", "kWh"),
    ("kj_per_k", "kJ/K"),
    ("k_per_kw", "K/kW"),
    ("kw_per_k", "kW/K"),
    ("kw_per_k_h", "kW/(K·h)"),
    ("kw_h_per_k", "kW·h/K"),
    ("k_h", "K·h"),
];

/// Endings of expectations, after the unit.
const COMPARISONS: [&str; 2] = ["_at_most", "_at_least"];

/// The unit that a key ends with, the longest if several match.
pub fn unit_of(key: &str) -> Option<&'static str> {
    split(key).map(|(_, unit)| unit)
}

/// The part of a key before its unit; the whole key if it ends with none.
pub fn quantity_of(key: &str) -> &str {
    split(key).map_or(key, |(quantity, _)| quantity)
}

fn split(key: &str) -> Option<(&str, &'static str)> {
    let key = COMPARISONS.iter().find_map(|comparison| key.strip_suffix(comparison)).unwrap_or(key);
    let stripped = |ending: &str| key.strip_suffix(ending)?.strip_suffix('_');
    let fitting = ENDINGS.iter().filter_map(|(ending, unit)| Some((stripped(ending)?, *unit)));
    fitting.min_by_key(|(quantity, _)| quantity.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_of_a_key_is_its_longest_matching_ending() {
        assert_eq!(unit_of("speed_mps"), Some("m/s"));
        assert_eq!(unit_of("integral_kw_per_k_h"), Some("kW/(K·h)"));
        assert_eq!(unit_of("front_stiffness_per_rad"), Some("1/rad"));
        assert_eq!(unit_of("early_kwh_at_least"), Some("kWh"));
        assert_eq!(unit_of("safety_weight"), None);
        assert_eq!(unit_of("m"), None, "a unit needs a quantity");
        assert_eq!((quantity_of("resistance_k_per_kw"), quantity_of("beta")), ("resistance", "beta"));
    }
}
