//! What designing a day costs: the whole day-ahead design of each controller, feedback included.
//!
//! ```sh
//! cargo bench -p interplay-building --bench design
//! ```
//!
//! The dissertation needed 120 s for an iteration of chapter 3, and 8.03 s (distributed) and 10.21 s (centralised) for one of
//! chapter 5, with four zones.

mod case;

use std::hint::black_box;
use std::time::Duration;

use criterion::{BatchSize, Criterion, SamplingMode, criterion_group, criterion_main};
use interplay_building::control::Controller;

use case::Case;

fn designs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("design");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).measurement_time(Duration::from_secs(5));
    let distributed = Controller::Distributed(Default::default());
    let centralised = Controller::Centralised(Default::default());
    let cases = [
        (Controller::Iterative(Default::default()), 2, 2),
        (Controller::Concurrent(Default::default()), 2, 2),
        (distributed.clone(), 2, 2),
        (centralised.clone(), 2, 2),
        (distributed.clone(), 3, 3),
        (distributed.clone(), 4, 4),
        (distributed.clone(), 5, 5),
        (distributed.clone(), 10, 10),
        (distributed.clone(), 20, 20),
        (centralised.clone(), 5, 5),
        (centralised.clone(), 10, 10),
    ];
    for (controller, rows, columns) in cases {
        let case = Case::new(controller.clone(), rows, columns);
        group.bench_function(format!("{} {}", controller.kind(), rows * columns), |bencher| {
            bencher.iter_batched(
                || case.controller.fork().expect("ours can be copied"),
                |mut controller| black_box(case.plan_day_ahead(&mut *controller)),
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, designs);
criterion_main!(benches);
