//! Temperatures of an instance beside those of the network.

use crate::house::{GUID, Resources, STEP_S, ambient_c, gains_kw, model, resources};
use crate::unit::{BOTH, ERROR, Fmi, OK, Unit};

#[test]
fn fmu_temperatures_equal_those_of_the_network() {
    let (model, steps) = (model(), 60);
    let folder = Resources::write("moves", &resources(&model, steps));
    for fmi in BOTH {
        let unit = Unit::new(fmi, folder.path(), GUID).expect("an instance");
        assert_eq!(unit.begin(0.0), OK);
        for round in 0..2 {
            let mut nodes_c = vec![20.0; model.network().node_count()];
            for step in 0..steps / 2 {
                let heat_kw = [0.5 * (step as f64).cos(), -0.2];
                assert_eq!(unit.set(&[0, 1], &heat_kw), OK);
                // Two steps at once.
                assert_eq!(unit.step(2.0 * STEP_S * step as f64, 2.0 * STEP_S), OK);
                for step in [2 * step, 2 * step + 1] {
                    model.step(&mut nodes_c, &heat_kw, ambient_c(step), &gains_kw(step));
                }
                let (status, values) = unit.get(&[2, 3, 0, 4, 5, 6]);
                let next = (2 * step + 2).min(steps - 1);
                let expected =
                    [nodes_c[0], nodes_c[1], heat_kw[0], gains_kw(next)[0], gains_kw(next)[1], ambient_c(next)];
                assert_eq!(status, OK);
                assert!(
                    values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-11),
                    "{fmi:?} {round} {step}: {values:?} {expected:?}"
                );
            }
            // The weather has ended.
            assert_eq!(unit.step(STEP_S * steps as f64, STEP_S), ERROR);
            assert_eq!(unit.reset(), OK);
        }
    }
}

#[test]
fn both_fmi_versions_compute_the_same_bits() {
    let steps = 50;
    let folder = Resources::write("bits", &resources(&model(), steps));
    let [two, three] = BOTH.map(|fmi| Unit::new(fmi, folder.path(), GUID).expect("an instance"));
    assert_eq!((two.begin(0.0), three.begin(0.0)), (OK, OK));
    let mut temperatures_c = Vec::new();
    for step in 0..steps {
        let heat_kw = [(step as f64).sin(), 0.1 * step as f64];
        let [values, others] = [&two, &three].map(|unit| {
            assert_eq!(unit.set(&[0, 1], &heat_kw), OK);
            assert_eq!(unit.step(STEP_S * step as f64, STEP_S), OK);
            unit.get(&[0, 1, 2, 3, 4, 5, 6]).1.into_iter().map(f64::to_bits).collect::<Vec<u64>>()
        });
        assert_eq!(values, others, "{step}");
        temperatures_c.push(values[2]);
    }
    temperatures_c.dedup();
    assert_eq!(temperatures_c.len(), steps, "the temperature changes at every step");
}

#[test]
fn a_simulation_begins_at_the_given_start_time() {
    let folder = Resources::write("begins", &resources(&model(), 10));
    for fmi in BOTH {
        let unit = Unit::new(fmi, folder.path(), GUID).expect("an instance");
        assert_eq!(unit.begin(3.0 * STEP_S), OK);
        assert_eq!(unit.get(&[6, 7]), (OK, vec![ambient_c(3), 3.0 * STEP_S]), "{fmi:?}");
        assert_eq!(unit.step(3.0 * STEP_S, STEP_S), OK);
    }
}

/// FMI 3.0 gives the folder as a path of the system, in which `%20` is not an escape.
#[test]
fn a_path_in_fmi_3_may_contain_a_percent_sign() {
    let folder = Resources::write("100%20", &resources(&model(), 3));
    assert!(Unit::new(Fmi::Three, folder.path(), GUID).is_ok());
}
