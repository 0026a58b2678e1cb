//! What several tests share: oracles, references, random scenes; here, random columns and patterns for property tests.

pub mod differences;
pub mod everyday;
pub mod friction_oracle;
pub mod imports;
pub mod oracle;
pub mod random;
pub mod reference;
pub mod replay;
pub mod stress;

use proptest::prelude::*;
use rocking::pattern::{Interface, Pattern};
use rocking::{Block, Column};

/// Blocks of very different sizes, capitals wider than shafts among them, with masses of their own.
pub fn column(blocks: usize) -> impl Strategy<Value = Column> {
    let block = (0.05f64..1.0, 0.05f64..1.0, 0.2f64..5.0, 0.5f64..1.5).prop_map(|(b, h, density, share)| {
        let mut block = Block::rectangle(b, h, density);
        block.inertia *= share;
        block
    });
    prop::collection::vec(block, blocks).prop_map(|blocks| Column::new(blocks, 9.81).expect("positive sizes"))
}

/// All patterns of a column but rest, mirror images included.
pub fn patterns(blocks: usize) -> Vec<Pattern> {
    (0..3usize.pow(blocks as u32))
        .map(|code| {
            let digit = |i: usize| Interface::ORDER[code / 3usize.pow(i as u32) % 3];
            Pattern((0..blocks).map(digit).collect())
        })
        .filter(|pattern| pattern.dof() > 0)
        .collect()
}

/// A deterministic runner: the same cases on every machine, and the seed is the runner's own.
pub fn runner(cases: u32) -> proptest::test_runner::TestRunner {
    use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

/// The blocks of [`column`] with other tops and centroids, displaced by up to two thirds of the way off their supports.
pub fn tapered_and_displaced(blocks: usize) -> impl Strategy<Value = Column> {
    let shares = (0.3f64..1.5, 0.3f64..1.7, -0.67f64..0.67);
    (column(blocks), prop::collection::vec(shares, blocks)).prop_map(|(column, shares)| {
        let changed = |(block, (top, centroid, _)): (&Block, &(f64, f64, f64))| Block {
            top_half_width: block.bottom_half_width * top,
            centroid_height: block.half_height * centroid,
            ..*block
        };
        let blocks: Vec<Block> = column.blocks().iter().zip(&shares).map(changed).collect();
        let support = |i: usize| blocks[i].bottom_half_width + if i == 0 { 0.0 } else { blocks[i - 1].top_half_width };
        let slides = shares.iter().enumerate().map(|(i, (_, _, share))| share * support(i)).collect();
        Column::new(blocks.clone(), 9.81).and_then(|column| column.displaced(slides)).expect("valid sizes")
    })
}
