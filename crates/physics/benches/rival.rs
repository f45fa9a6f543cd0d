//! How much faster is the detection than the paper's rival, and how do both grow with the number of polygons?
//!
//! `cargo bench -p physics --bench rival` runs criterion's groups on the paper's two data sets, and
//! `cargo bench -p physics --bench rival -- report` lets the contenders take turns on data sets from 419 to 100,000
//! polygons and writes docs/rival.md and docs/rival.svg; numbers after `report` take the place of those sizes and
//! only print. The target: parametric shapes at least 100 times as fast as the rival at 970 polygons; the paper found
//! 2.5 to 8.
#![allow(
    clippy::disallowed_methods,
    reason = "a report may come from any library"
)]

#[path = "rival/contenders.rs"]
mod contenders;
#[path = "query/machine.rs"]
mod machine;
#[path = "rival/plot.rs"]
mod plot;
#[path = "rival/report.rs"]
mod report;
#[path = "../tests/support/mod.rs"]
mod support;

use std::hint::black_box;

use contenders::{Contender, DataSet, Workload};
use criterion::Criterion;
use physics::rival::PAPER_POLYGONS;

fn main() {
    let mut words = std::env::args().skip_while(|word| word != "report");
    if words.next().is_some() {
        let sizes: Vec<usize> = words.filter_map(|word| word.parse().ok()).collect();
        if sizes.is_empty() {
            report::write();
        } else {
            report::print(&sizes);
        }
        return;
    }
    let mut criterion = Criterion::default().configure_from_args();
    for polygons in PAPER_POLYGONS {
        let data_set = DataSet::new(polygons);
        let scene = data_set.scene();
        for workload in Workload::ALL {
            let name = format!("{polygons} polygons, {}", workload.name());
            let mut group = criterion.benchmark_group(name);
            group.sample_size(20);
            for contender in Contender::ALL {
                let mut run = scene.runner(contender, workload);
                group.bench_function(contender.name(), |b| b.iter(|| black_box(run())));
            }
            group.finish();
        }
    }
    criterion.final_summary();
}
