//! What the library claims about whole runs, a file for each claim; `common` holds what files share.
//!
//! Run the tests of a file by its name: `cargo test --release --test solver stress::`. Those of files whose names end so run as well.

mod common;

// The house: modules, documents, generated code.
mod architecture;
mod documents;
mod golden_equations;
mod scalars;
mod straight_line_code;

// Scenes and what is asked of them.
mod library;
mod pulses;
mod row_times;
mod scenes;
mod serialised_scenes;
mod sweeps;

// Equations of motion and contact laws.
mod friction_oracle;
mod generated_agrees_with_generic;
mod invariants;
mod oracle_contact;
mod tapered_and_displaced;

// Whole runs: every bit of them, their events, what may be skipped, how they end.
mod auto;
mod critical_events;
mod digests;
mod equal_drums;
mod friction;
mod outcome;
mod replay;
mod skips;
mod stick_angle;
mod stress;
mod stress_friction;
mod tall_columns;
mod validity;

// Against closed forms, other programs and published results.
mod paper_with_friction;
mod validation_closed_forms;
mod validation_extended_precision;
mod validation_friction;
mod validation_moreau_jean;
mod validation_slender_limit;
mod validation_two_blocks;

// Studies.
mod fragility;
