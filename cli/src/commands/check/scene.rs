//! `rocking check` of a scene: its column, its ground motion and its contacts, and what opens or slides first.

use super::contacts::{self, Openings};
use crate::commands::thresholds;
use crate::error::Failure;
use crate::ground_in_words;
use crate::number::{self, coefficients, fixed, significant, widths};
use crate::terminal::{json, print, warn};
use crate::text::{printable, shown};
use rocking::scene::Initial;
use rocking::scene_file::{Derived, SceneFile};
use rocking::{Block, Column, ContactAtRest, Friction, Motion, Restitution, Scene, SolveOptions};
use serde::{Serialize, Serializer};
use std::fmt::Write as _;
use std::path::Path;

/// Reads a scene and explains it.
pub fn check(path: &Path, text: &str, as_json: bool) -> Result<(), Failure> {
    let SceneFile { scene, derived } = SceneFile::from_toml(text, path).map_err(Failure::scene)?;
    let findings = Findings::of(&scene, derived);
    warn(&findings.warnings);
    if as_json { json(&findings) } else { print(&findings.text(path, &scene)) }
}

/// Description of a scene. Lists have N entries, per block or interface, base first.
#[derive(Debug, Serialize)]
struct Findings {
    title: String,
    /// `[m/s²]`
    gravity: f64,
    blocks: Vec<Block>,
    derived: Vec<Derived>,
    stacks: Vec<thresholds::Row>,
    friction: Option<Friction>,
    restitution: Restitution,
    /// Factors of the plastic relative rates at the interfaces, dimensionless.
    restitution_factors: Vec<f64>,
    /// What the ground motion does to each contact of the column at rest.
    contacts: Vec<ContactAtRest>,
    horizontal: Option<MotionFindings>,
    vertical: Option<MotionFindings>,
    /// State at t = 0.
    initial: Initial,
    /// Slides at t = 0 `[m]`.
    slides: Vec<f64>,
    /// Interfaces, from 1, that the ground motion opens from rest, if none of the others opens or slides before.
    opens: Vec<usize>,
    /// When the first of them opens `[s]`.
    first_opening: Option<f64>,
    /// Method of the smooth phases: that which `auto` chooses.
    method: &'static str,
    options: SolveOptions,
    rows: u64,
    /// Warnings about records and numbers ([`Scene::warnings`]).
    warnings: Vec<String>,
}

/// Rounding of a factor of restitution times Housner's ratio that may be one.
const ROUNDING_OF_RATIOS: f64 = 1e-12;

/// A component of the ground motion.
#[derive(Debug, Serialize)]
struct MotionFindings {
    #[serde(flatten)]
    #[serde(serialize_with = "described")]
    motion: Motion,
    /// Largest acceleration of the ground until the end of the run `[m/s²]`.
    pga: f64,
    /// Largest velocity of the ground until the end of the run `[m/s]`.
    pgv: f64,
    /// Largest displacement of the ground until the end of the run `[m]`.
    pgd: f64,
    /// End of the motion `[s]`; none for a motion without end.
    end: Option<f64>,
    /// Velocity and displacement of the ground at the end of the motion `[m/s]`, `[m]`; none for a motion without end.
    left_with: Option<[f64; 2]>,
}

/// Serialises the description of a motion, without the samples of records.
fn described<S: Serializer>(motion: &Motion, serializer: S) -> Result<S::Ok, S::Error> {
    motion.description().serialize(serializer)
}

/// The state at t = 0 in words; `None` for a column that stands upright, not displaced and at rest.
fn initial(scene: &Scene) -> Option<String> {
    let Initial { theta, omega, x, y, vx, vy, .. } = &scene.initial;
    number::state(&[
        ("theta", theta, "rad"),
        ("omega", omega, "rad/s"),
        ("slide", scene.column.slides(), "m"),
        ("x", x, "m"),
        ("y", y, "m"),
        ("vx", vx, "m/s"),
        ("vy", vy, "m/s"),
    ])
}

impl Findings {
    fn of(scene: &Scene, derived: Vec<Derived>) -> Findings {
        let column = &scene.column;
        let stacks = thresholds::rows(scene);
        let component =
            |motion: &Option<Motion>| motion.as_ref().map(|motion| MotionFindings::of(motion, scene.options.t_end));
        let contacts = scene.contacts_at_rest();
        let openings = Openings::of(&contacts, column.gravity());
        Findings {
            title: scene.title.clone(),
            gravity: column.gravity(),
            blocks: column.blocks().to_vec(),
            derived,
            opens: openings.interfaces(),
            first_opening: openings.first(),
            contacts,
            stacks,
            friction: scene.friction.clone(),
            restitution: scene.restitution.clone(),
            restitution_factors: scene.restitution.factors(column),
            horizontal: component(&scene.excitation.horizontal),
            vertical: component(&scene.excitation.vertical),
            initial: scene.initial.clone(),
            slides: column.slides().to_vec(),
            method: scene.options.method.stepper().name(),
            options: scene.options.clone(),
            rows: scene.row_times().count() as u64,
            warnings: scene.warnings(),
        }
    }

    fn text(&self, path: &Path, scene: &Scene) -> String {
        let mut text = format!("{}: a valid scene", shown(path));
        if !self.title.is_empty() {
            let _ = write!(text, ", {}", printable(&self.title));
        }
        text.push('\n');
        self.column(&mut text, scene);
        if let Some(state) = initial(scene) {
            let _ = writeln!(text, "\nat t = 0: {state}");
            text.push_str(thresholds::note_of_places(scene));
            self.past_balance(&mut text);
        }
        self.ground(&mut text, scene);
        self.friction(&mut text, scene);
        let options = &scene.options;
        let steps = match options.method.has_step_control() {
            true => format!("rtol {:e}, atol {:e}", options.rtol, options.atol),
            false => format!("steps of {} s", options.step),
        };
        let _ = writeln!(
            text,
            "\nrun until {} s with method {}{}, {steps}; {} row(s) in response.csv",
            options.t_end,
            self.method,
            if options.method.name() == self.method { "" } else { " (chosen by auto)" },
            self.rows
        );
        text
    }

    /// Notes blocks that begin past their balance, where stacks have one balance to both sides: they are neither displaced nor placed block by block.
    fn past_balance(&self, text: &mut String) {
        if !self.initial.x.is_empty() || self.slides.iter().any(|slide| *slide != 0.0) {
            return;
        }
        let angles = self.initial.theta.iter().zip(&self.stacks);
        let past = angles.filter(|(theta, stack)| theta.abs() > stack.slenderness);
        for (theta, stack) in past {
            let _ = writeln!(
                text,
                "note: block {} begins past its balance: at {} rad ({:.1}°), with a slenderness of {:.4} rad of the stack from there up",
                stack.interface,
                significant(theta.abs(), 5),
                theta.abs().to_degrees(),
                stack.slenderness
            );
        }
    }

    fn column(&self, text: &mut String, scene: &Scene) {
        let whole = &self.stacks[0];
        let gravity = scene.column.gravity();
        let _ = writeln!(
            text,
            "\ncolumn of {} block(s): {:.4} m tall, {} kg, gravity {gravity} m/s²\n\
             as one body: slenderness alpha = {:.4} rad ({:.2}°), R = {:.4} m, p = {:.4} rad/s",
            self.blocks.len(),
            whole.stack.height,
            significant(whole.stack.mass, 6),
            whole.slenderness,
            whole.slenderness.to_degrees(),
            whole.stack.radius(),
            whole.frequency_parameter
        );
        self.table_of_blocks(text);
        self.table_of_stacks(text, &scene.column);
        self.restitution(text, scene);
    }

    fn table_of_blocks(&self, text: &mut String) {
        text.push_str("\nblock  width [m]  height [m]  mass [kg]     inertia [kg m²]   (base first)\n");
        for (index, block) in self.blocks.iter().enumerate() {
            let _ = writeln!(
                text,
                "{:<6} {:<10} {:<11.4} {:<13} {}",
                index + 1,
                widths(block, 4),
                2.0 * block.half_height,
                significant(block.mass, 6),
                significant(block.inertia, 6)
            );
        }
        if !self.derived.is_empty() {
            text.push_str("derived, not given:\n");
            for Derived { key, value, unit, from } in &self.derived {
                let _ = writeln!(text, "  {key} = {} {unit}: {from}", significant(*value, 6));
            }
        }
    }

    fn table_of_stacks(&self, text: &mut String, column: &Column) {
        text.push_str(
            "\nthe stack above each interface as one body, c distance of its centre of gravity from the nearer end of its contact, h_P its height:\n\
             interface  c [m]    h_P [m]  alpha [rad]  p [rad/s]  opens at [m/s2]  [g]      Housner's ratio\n",
        );
        for stack in &self.stacks {
            let _ = writeln!(
                text,
                "{:<10} {:<8.4} {:<8.4} {:<12.4} {:<10.4} {:<16.4} {:<8.4} {:.4}",
                stack.interface,
                stack.stack.half_width,
                stack.stack.centroid_height,
                stack.slenderness,
                stack.frequency_parameter,
                stack.uplift_acceleration,
                stack.uplift_acceleration / column.gravity(),
                stack.housner_ratio
            );
        }
        if self.contacts.iter().any(|contact| !contact.is_symmetric) {
            text.push_str("Housner's ratio of a displaced stack is that of the stack above the middle of its contact; its impacts to either side have other ratios\n");
        }
        let falling = self.stacks.iter().filter(|stack| stack.slenderness <= 0.0);
        let falling: Vec<String> = falling.map(|stack| stack.interface.to_string()).collect();
        if !falling.is_empty() {
            let _ = writeln!(
                text,
                "the stack above interface(s) {} does not stand by itself: its weight acts beyond the contact",
                falling.join(", ")
            );
        }
    }

    fn restitution(&self, text: &mut String, scene: &Scene) {
        let factors: Vec<String> = self.restitution_factors.iter().map(|factor| format!("{factor:.4}")).collect();
        let factors = factors.join(", ");
        let _ = match &scene.restitution {
            Restitution::Plastic => {
                writeln!(text, "impacts: plastic, nothing rebounds (Housner's ratio for one block)")
            }
            Restitution::Eta(eta) => writeln!(
                text,
                "impacts: eta = {eta} for the column as one body, {factors} of the plastic relative rate at each interface"
            ),
            _ => writeln!(text, "impacts: {factors} of the plastic relative rate, base first"),
        };
        if let ([block], Restitution::Eta(eta), Some(friction)) =
            (&self.stacks[..], &scene.restitution, &scene.friction)
        {
            let needed = block.stack.centroid_height / block.stack.half_width * (1.0 - eta) / (1.0 + eta);
            let kinetic = friction.kinetic[0];
            if needed > kinetic {
                let _ = writeln!(
                    text,
                    "  an impact at which nothing slides needs a coefficient of friction of {}; with {} restitution is left out",
                    significant(needed, 4),
                    significant(kinetic, 4)
                );
            }
        }
        let gains = |(stack, factor): &(&thresholds::Row, &f64)| {
            **factor != 1.0 && **factor * stack.housner_ratio > 1.0 + ROUNDING_OF_RATIOS
        };
        let gaining = self.stacks.iter().zip(&self.restitution_factors).filter(gains);
        let gaining: Vec<String> = gaining.map(|(stack, _)| stack.interface.to_string()).collect();
        if !gaining.is_empty() {
            let _ = writeln!(
                text,
                "  where interface(s) {} alone are open, the stack above would gain energy (factor times Housner's ratio above 1), and restitution is \
                 left out; it may act where others are open as well",
                gaining.join(", ")
            );
        }
    }

    fn friction(&self, text: &mut String, scene: &Scene) {
        let gravity = scene.column.gravity();
        let Some(friction) = &scene.friction else {
            text.push_str("\nfriction is not given: blocks neither slide nor fly\n");
            return;
        };
        let _ = writeln!(
            text,
            "\nfriction: {}; blocks slide and fly\neach interface by itself, the stack above as one body at rest (if another one opens or slides before, it may hold):",
            coefficients(friction)
        );
        for contact in &self.contacts {
            let _ = writeln!(text, "  {}", contacts::first_motion(contact, gravity));
        }
    }

    fn ground(&self, text: &mut String, scene: &Scene) {
        let gravity = scene.column.gravity();
        let components = [("horizontal", &self.horizontal), ("vertical", &self.vertical)];
        if components.iter().all(|(_, motion)| motion.is_none()) {
            text.push_str("\nthe ground does not move\n");
        }
        for (component, motion) in components {
            if let Some(motion) = motion {
                let _ = writeln!(text, "\n{component} ground motion: {}", motion.words(gravity));
                motion.sizes(text, gravity, scene.options.t_end);
            }
        }
        self.openings(text, scene);
    }

    /// Which interfaces the ground motion opens of the column at rest.
    fn openings(&self, text: &mut String, scene: &Scene) {
        let openings = Openings::of(&self.contacts, scene.column.gravity());
        let is_displaced = scene.column.slides().iter().any(|slide| *slide != 0.0);
        let told = match (&self.horizontal, &self.vertical) {
            (None, None) => return,
            (horizontal, Some(_)) => openings.with_vertical_motion(horizontal.is_some()),
            (Some(motion), None) => openings.under_a_peak_of(motion.pga, is_displaced),
        };
        let _ = writeln!(text, "  {told}");
    }
}

/// Share of the largest displacement of the ground that is left at its end, above which a word on it is due.
const DISPLACED_SHARE: f64 = 0.5;

impl MotionFindings {
    fn of(motion: &Motion, t_end: f64) -> MotionFindings {
        let [pga, pgv, pgd] = motion.peaks(0.0, t_end);
        let end = motion.end();
        MotionFindings { motion: motion.clone(), pga, pgv, pgd, end, left_with: end.map(|end| motion.travel(end)) }
    }

    fn words(&self, gravity: f64) -> String {
        ground_in_words::words(&serde_json::to_value(self.motion.description()).unwrap_or_default(), gravity, 0.0)
    }

    /// Peaks up to the end of the run, and how the motion ends.
    fn sizes(&self, text: &mut String, gravity: f64, t_end: f64) {
        let MotionFindings { pga, pgv, pgd, .. } = self;
        let in_g = pga / gravity;
        let _ = writeln!(text, "  PGA {in_g:.4} g ({pga:.4} m/s²), PGV {pgv:.4} m/s, PGD {pgd:.4} m until {t_end} s");
        let (Some(end), Some([velocity, displacement])) = (self.end, self.left_with) else {
            text.push_str("  goes on for ever\n");
            return;
        };
        let left = match velocity.is_finite() && displacement.is_finite() {
            true => format!("with {} m/s, displaced by {} m", fixed(velocity, 4), fixed(displacement, 4)),
            false => "beyond what numbers hold".into(),
        };
        let is_displaced = displacement.abs() > DISPLACED_SHARE * pgd;
        let unfelt = if is_displaced { " (which does not load the column: accelerations alone do)" } else { "" };
        let _ = writeln!(text, "  ends at {end:.4} s; the ground is left {left}{unfelt}");
        // Zeros at the end of a record are no motion.
        if self.motion.moves_after(t_end) {
            let _ = writeln!(text, "  note: that is after the end of the run, solver.t_end");
        }
    }
}
