//! What simulating and planning cost.
//!
//! ```sh
//! cargo bench -p interplay-building --bench building
//! ```
//!
//! `year/…`: 35,040 steps of a quarter of an hour, with changing inputs and weather. `discretise/…`: making the model.
//! `optimum/…`: the clairvoyant plan of a day of half-hourly steps. `lifted/…`: a product with G over a day.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, SamplingMode, criterion_group, criterion_main};
use interplay_building::comfort::Setpoints;
use interplay_building::control::{Disturbance, optimum};
use interplay_building::discretise::{Discretisation, Form, Model};
use interplay_building::lifted::Lifted;
use interplay_building::network::Network;

const QUARTER_S: f64 = 900.0;
const HALF_HOUR_S: f64 = 1800.0;
const STEPS_OF_A_YEAR: usize = 365 * 96;

/// 25 by 40 rooms.
fn thousand() -> Network {
    Network::grid(25, 40)
}

fn model(network: &Network, method: Discretisation, step_s: f64) -> Model {
    Model::new(network, method, step_s).expect("the testbed's rooms are slow enough for any of these steps")
}

/// Temperatures after a year of inputs and weather that change with every step.
fn year(model: &Model) -> f64 {
    let n = model.network().zone_count();
    let mut temperatures_c = vec![25.0_f64; model.network().node_count()];
    let (mut heat_kw, gains_kw) = (vec![0.0; n], vec![0.2; n]);
    for step in 0..STEPS_OF_A_YEAR {
        for (zone, heat_kw) in heat_kw.iter_mut().enumerate() {
            *heat_kw = (24.0 - temperatures_c[zone]).clamp(-2.0, 2.0);
        }
        let ambient_c = 28.0 + (step % 96) as f64 / 32.0;
        model.step(&mut temperatures_c, &heat_kw, ambient_c, &gains_kw);
    }
    temperatures_c.iter().sum()
}

fn years(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("year");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).measurement_time(Duration::from_secs(60));
    for method in [Discretisation::Exact, Discretisation::Euler] {
        let model = model(&thousand(), method, QUARTER_S);
        group.bench_function(format!("1000 zones {method:?}"), |bencher| bencher.iter(|| black_box(year(&model))));
    }
    let model = model(&Network::testbed(), Discretisation::Exact, QUARTER_S);
    group.bench_function("testbed Exact", |bencher| bencher.iter(|| black_box(year(&model))));
    group.finish();
}

fn discretise(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("discretise");
    group.sample_size(10);
    for (name, form, network) in [
        ("testbed dense", Form::Dense, Network::testbed()),
        ("256 zones dense", Form::Dense, Network::grid(16, 16)),
        ("1000 zones series", Form::Series, thousand()),
    ] {
        group.bench_function(name, |bencher| bencher.iter(|| Model::exact_in(form, black_box(&network), QUARTER_S)));
    }
    group.finish();
}

fn optima(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("optimum");
    group.sample_size(10);
    for (name, method, network) in [
        ("testbed Exact", Discretisation::Exact, Network::testbed()),
        ("25 zones Exact", Discretisation::Exact, Network::grid(5, 5)),
        ("25 zones Euler", Discretisation::Euler, Network::grid(5, 5)),
        ("100 zones Euler", Discretisation::Euler, Network::grid(10, 10)),
    ] {
        let n = network.zone_count();
        let lifted = Lifted::new(&model(&network, method, HALF_HOUR_S), 48);
        let setpoints = Setpoints { occupied_c: vec![23.0], ..Setpoints::default() };
        let targets = setpoints.targets(n, HALF_HOUR_S, 48).expect("valid");
        let day = Disturbance { ambient_c: vec![30.0; 48], gains_kw: vec![0.3; 48 * n] };
        group.bench_function(name, |bencher| {
            bencher.iter(|| optimum(&lifted, &vec![28.0; n], &targets, black_box(&day), None));
        });
    }
    group.finish();
}

fn products(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("lifted");
    for (name, network) in [("testbed", Network::testbed()), ("1000 zones", thousand())] {
        let lifted = Lifted::new(&model(&network, Discretisation::Exact, HALF_HOUR_S), 48);
        let u = vec![1.0; lifted.size()];
        group.bench_function(format!("{name} G u"), |bencher| bencher.iter(|| lifted.product(black_box(&u))));
        group.bench_function(format!("{name} Gᵀ y"), |bencher| {
            bencher.iter(|| lifted.transpose_product(black_box(&u)))
        });
        group.bench_function(format!("{name} G⁻¹ y"), |bencher| bencher.iter(|| lifted.solve(black_box(&u))));
    }
    group.finish();
}

criterion_group!(benches, discretise, optima, products, years);
criterion_main!(benches);
