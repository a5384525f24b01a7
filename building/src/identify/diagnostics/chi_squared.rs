//! The chi-squared distribution.

/// The probability that a chi-squared variable with `degrees` of freedom exceeds `value`: the regularised incomplete gamma
/// function Q(k/2, x/2), by its series for small x and by Lentz's continued fraction for large x.
pub(in crate::identify) fn survival(value: f64, degrees: f64) -> f64 {
    let (shape, x) = (degrees / 2.0, value / 2.0);
    if x <= 0.0 {
        return 1.0;
    }
    let front = libm::exp(shape * libm::log(x) - x - libm::lgamma(shape));
    let probability = if x < shape + 1.0 { 1.0 - front * series(shape, x) } else { front * fraction(shape, x) };
    probability.clamp(0.0, 1.0)
}

/// Σ_n xⁿ / (a (a+1) … (a+n)).
fn series(shape: f64, x: f64) -> f64 {
    let mut term = 1.0 / shape;
    let mut sum = term;
    let mut denominator = shape;
    while term > sum * 1e-16 {
        denominator += 1.0;
        term *= x / denominator;
        sum += term;
    }
    sum
}

/// 1/(x+1−a − 1(1−a)/(x+3−a − 2(2−a)/(x+5−a − …))).
fn fraction(shape: f64, x: f64) -> f64 {
    /// Smallest magnitude of a denominator; zeros are replaced by it, as in the modified method of Lentz. Its inverse is still
    /// finite.
    const MIN_DENOMINATOR: f64 = 1e-300;
    let mut b = x + 1.0 - shape;
    let mut c = 1.0 / MIN_DENOMINATOR;
    let mut d = 1.0 / b;
    let mut value = d;
    for n in 1..10_000 {
        let a = -f64::from(n) * (f64::from(n) - shape);
        b += 2.0;
        let guarded = |x: f64| if x.abs() < MIN_DENOMINATOR { MIN_DENOMINATOR } else { x };
        d = 1.0 / guarded(a * d + b);
        c = guarded(b + a / c);
        let factor = d * c;
        value *= factor;
        if (factor - 1.0).abs() < 1e-15 {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::survival;

    /// With two degrees of freedom it is an exponential, with four twice an Erlang: closed forms.
    #[test]
    fn the_chi_squared_tail_of_even_degrees_has_its_closed_form() {
        for step in 1..400 {
            let x = f64::from(step) * 0.25;
            let half = x / 2.0;
            assert!((survival(x, 2.0) - (-half).exp()).abs() < 1e-14);
            assert!((survival(x, 4.0) - (-half).exp() * (1.0 + half)).abs() < 1e-14);
            let six = (-half).exp() * (1.0 + half + half * half / 2.0);
            assert!((survival(x, 6.0) - six).abs() < 1e-14);
        }
    }

    /// Tabulated 5 % points.
    #[test]
    fn five_percent_points_of_chi_squared_match_published_tables() {
        for (degrees, value) in [(1.0, 3.841_458_820_694), (10.0, 18.307_038_053_275), (45.0, 61.656_233_376_279_6)] {
            assert!((survival(value, degrees) - 0.05).abs() < 1e-9);
        }
    }

    proptest! {
        #[test]
        fn the_chi_squared_tail_falls_from_one_to_zero(degrees in 1.0..200.0_f64, low in 0.0..300.0, more in 0.01..50.0) {
            let (a, b) = (survival(low, degrees), survival(low + more, degrees));
            prop_assert!((0.0..=1.0).contains(&a) && b <= a + 1e-14);
        }
    }
}
