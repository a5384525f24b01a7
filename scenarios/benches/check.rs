//! The time to check scenarios.
//!
//! ```sh
//! cargo bench -p interplay-scenarios
//! ```
//!
//! `check/all embedded`: every authored scenario read, its parents included, merged and checked.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use interplay_scenarios::{embedded, load};

fn check(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("check");
    group.bench_function("all embedded", |bencher| {
        bencher.iter(|| {
            for file in embedded() {
                black_box(load(file.name, &[]).expect("authored scenarios are sound"));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, check);
criterion_main!(benches);
