//! scratch
#![allow(clippy::print_stdout)]
use interplay_convex::*;
use std::time::Instant;
fn main() {
    let n = 20;
    let mut p = Program::new();
    let x = p.variables("x", 4 * (n + 1));
    let u = p.variables("u", 2 * n);
    let sl = p.variables("slack", n);
    let dy = p.equal("dyn");
    let lim = p.at_most("lim");
    let ball = p.second_order("ball", 3);
    let write = |p: &mut Program, r: f64| {
        p.clear();
        for k in 0..=n {
            for i in 0..4 {
                let v = x.at(4 * k + i);
                p.quadratic(v, v, 1.0 + r);
                p.linear(v, -1.0 - r * (i as f64));
            }
        }
        for k in 0..n {
            for i in 0..2 {
                let v = u.at(2 * k + i);
                p.quadratic(v, v, 0.1);
                p.row(lim, [(v, 1.0)], 1.0);
                p.row(lim, [(v, -1.0)], 1.0);
            }
            p.linear(sl.at(k), 100.0);
            p.row(lim, [(sl.at(k), -1.0)], 0.0);
            for i in 0..4 {
                p.row(
                    dy,
                    (0..4)
                        .map(|j| (x.at(4 * k + j), if i == j { 1.0 } else { 0.05 * r }))
                        .chain([(u.at(2 * k + i % 2), 0.1), (x.at(4 * k + 4 + i), -1.0)]),
                    0.0,
                );
            }
            p.row(lim, [(x.at(4 * k + 4), 1.0 + r), (x.at(4 * k + 5), r), (sl.at(k), -1.0)], 0.3);
            p.row(ball, [], 2.0);
            p.row(ball, [(x.at(4 * k + 4), -1.0)], 0.0);
            p.row(ball, [(x.at(4 * k + 5), -1.0)], 0.0);
        }
        for i in 0..4 {
            p.row(dy, [(x.at(i), 1.0)], 0.5 * r);
        }
    };
    write(&mut p, 0.1);
    let s = Settings::default();
    let mut solver = Solver::new(&p, &s).unwrap();
    let reps = 200;
    let (mut tn, mut tu, mut ts, mut tw, mut it) = (0.0, 0.0, 0.0, 0.0, 0);
    for k in 0..reps {
        let r = 0.1 + 0.001 * k as f64;
        let t = Instant::now();
        write(&mut p, r);
        tw += t.elapsed().as_secs_f64();
        let t = Instant::now();
        let fresh = Solver::new(&p, &s).unwrap();
        tn += t.elapsed().as_secs_f64();
        drop(fresh);
        let t = Instant::now();
        solver.update(&p).unwrap();
        tu += t.elapsed().as_secs_f64();
        let t = Instant::now();
        let sol = solver.solve();
        ts += t.elapsed().as_secs_f64();
        match sol {
            Ok(sol) => {
                it += sol.iterations;
                assert!(sol.residuals.largest() < 1e-7)
            }
            Err(e) => panic!("{e}"),
        }
    }
    let us = |t: f64| t / reps as f64 * 1e6;
    println!(
        "vars {} rows {} write {:.1} new {:.1} update {:.1} solve {:.1} us, {} it",
        p.variable_count(),
        p.row_count(),
        us(tw),
        us(tn),
        us(tu),
        us(ts),
        it / reps
    );
}
