//! Froude's law of similarity: the growth of a quantity with the ratio of lengths.

/// The factor by which a quantity of that unit grows if lengths are `scale` times as large: lengths by `λ`, times and speeds by
/// `√λ`, accelerations and angles by 1. A quantity not made of metres and seconds stays.
pub(super) fn factor(unit: &str, scale: f64) -> f64 {
    let mut halves = 0;
    for (position, part) in unit.split('/').enumerate() {
        let sign = if position == 0 { 1 } else { -1 };
        halves += part.trim_matches(['(', ')']).split('·').map(|base| sign * half_powers(base)).sum::<i32>();
    }
    power(scale, halves)
}

/// The power of `√λ` with which one base unit grows.
fn half_powers(base: &str) -> i32 {
    let of_one = match base.trim_end_matches(|character: char| SUPERSCRIPTS.contains(&character)) {
        "m" => 2,
        "s" => 1,
        _ => return 0,
    };
    let exponent = base.chars().last().and_then(|last| SUPERSCRIPTS.iter().position(|digit| *digit == last));
    of_one * exponent.map_or(1, |index| index as i32 + 2)
}

/// The exponents from 2.
const SUPERSCRIPTS: [char; 3] = ['²', '³', '⁴'];

/// `λ^(halves/2)`. Whole powers need no root, so they are exact for small whole ratios.
fn power(scale: f64, halves: i32) -> f64 {
    let root = if halves % 2 == 0 { 1.0 } else { scale.sqrt() };
    let whole = (0..halves.abs() / 2).fold(root, |product, _| product * scale);
    if halves < 0 { 1.0 / whole } else { whole }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_grow_by_froude_s_law() {
        for (unit, expected) in [
            ("m", 16.0),
            ("m²", 256.0),
            ("s", 4.0),
            ("m/s", 4.0),
            ("m/s²", 1.0),
            ("m/s³", 0.25),
            ("1/m²", 1.0 / 256.0),
            ("s²/m²", 1.0 / 16.0),
            ("s⁴/m²", 1.0),
            ("s/m", 0.25),
            ("rad", 1.0),
            ("1/rad²", 1.0),
            ("rad/s", 0.25),
            ("deg", 1.0),
            ("dimensionless", 1.0),
            ("kW/(K·h)", 1.0),
        ] {
            assert_eq!(factor(unit, 16.0), expected, "{unit}");
        }
        assert_eq!((factor("m", 10.0), factor("1/m²", 10.0)), (10.0, 0.01));
    }
}
