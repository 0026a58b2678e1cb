//! `rocking check` of a scene: its column, its ground motion and its contacts, and what opens or slides first.

use crate::commands::thresholds;
use crate::error::Failure;
use crate::ground_in_words;
use crate::number::{self, coefficients, fixed, significant, widths};
use crate::terminal::{json, print, warn};
use crate::text::{printable, shown};
use rocking::scene::Initial;
use rocking::scene_file::{Derived, SceneFile};
use rocking::{Block, Column, Friction, Motion, Restitution, Scene};
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
    blocks: Vec<Block>,
    derived: Vec<Derived>,
    stacks: Vec<thresholds::Row>,
    /// Factors of the plastic relative rates at the interfaces, dimensionless.
    restitution_factors: Vec<f64>,
    /// What gives way first at each interface; empty for a scene without friction.
    contacts: Vec<ContactFindings>,
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
    /// When each interface opens `[s]`, base first.
    #[serde(skip)]
    openings: Vec<Option<f64>>,
    method: &'static str,
    rows: u64,
    /// Warnings about records and numbers ([`Scene::warnings`]).
    warnings: Vec<String>,
}

/// Times that differ by no more than this are one `[s]`: each is found to rounding.
const AT_ONCE: f64 = 1e-9;

/// Share of gravity that may be left where a vertical motion takes all weight: the time is found to rounding.
const WEIGHTLESS: f64 = 1e-9;

/// Rounding of ratios that may be one: a factor of restitution times Housner's ratio, accelerations that slide and that open.
const ROUNDING_OF_RATIOS: f64 = 1e-12;

/// What gives way first at an interface: the contact slides, or it opens. The stack above counts as one body.
#[derive(Debug, Serialize)]
struct ContactFindings {
    /// From 1, base first.
    interface: usize,
    /// Coefficient of static friction, dimensionless.
    coefficient: f64,
    /// Horizontal ground acceleration at which the contact slides, without vertical motion `[m/s²]`.
    slides_at: f64,
    /// Horizontal ground acceleration at which the contact opens, to the side to which it takes less, without vertical motion `[m/s²]`.
    opens_at: f64,
    /// First time at which the ground motion slides this contact of a column still at rest `[s]`; `None` if never.
    slides_from: Option<f64>,
    /// First time at which the ground motion opens this contact of a column still at rest `[s]`; `None` if never.
    opens_from: Option<f64>,
    /// When the vertical motion takes all weight from a contact that neither slides nor opens before `[s]`.
    #[serde(skip)]
    weightless: Option<f64>,
    /// Whether both sides take the same.
    is_symmetric: bool,
    /// `rests`, `slides`, `rocks` or `slides-and-rocks` under the largest horizontal acceleration of the ground; `None` if the ground moves vertically
    /// as well, one side takes less than the other, or the contact slides and opens at the same acceleration.
    at_pga: Option<&'static str>,
    /// Least coefficient with which the stack would rock at the PGA without sliding; `None` if the contact slides first, or does not open.
    coefficient_to_rock: Option<f64>,
}

impl ContactFindings {
    /// The contact below a stack under a peak ground acceleration `[m/s²]`, `None` if the ground moves vertically as well. `[slides, opens]` are the first
    /// times at which it does `[s]`.
    fn of(
        stack: &thresholds::Row,
        friction: &Friction,
        pga: Option<f64>,
        is_symmetric: bool,
        [slides_from, opens_from]: [Option<f64>; 2],
    ) -> ContactFindings {
        let pga = pga.filter(|_| is_symmetric);
        let of_contact = |list: &[f64]| list[(stack.interface - 1).min(list.len() - 1)];
        let [coefficient, kinetic] = [&friction.fixed, &friction.kinetic].map(|list| of_contact(list));
        let (slides_at, opens_at) = (coefficient * stack.stack.gravity, stack.uplift_acceleration);
        // What follows where both are passed at once, no formula of one of them says.
        let pga = pga.filter(|_| (slides_at - opens_at).abs() > ROUNDING_OF_RATIOS * opens_at.abs());
        let opens_by = pga.filter(|pga| slides_at > opens_at && *pga > opens_at && opens_at > 0.0);
        let needed = opens_by.map(|pga| stack.stack.coefficient_to_rock(pga));
        let at_pga = pga.map(|pga| match needed {
            // A slide turns the stack only with more kinetic friction than that at which it opens.
            Some(needed) if coefficient < needed && kinetic * stack.stack.gravity <= opens_at => "slides",
            Some(needed) if coefficient < needed => "slides-and-rocks",
            Some(_) => "rocks",
            None if opens_at <= 0.0 => "rocks",
            None if pga > slides_at && slides_at <= opens_at => "slides",
            None => "rests",
        });
        let interface = stack.interface;
        ContactFindings {
            interface,
            coefficient,
            slides_at,
            opens_at,
            slides_from,
            opens_from,
            weightless: None,
            is_symmetric,
            at_pga,
            coefficient_to_rock: needed,
        }
    }

    /// In a sentence.
    fn text(&self, gravity: f64) -> String {
        let ContactFindings { interface, coefficient, .. } = self;
        let [slides, opens] =
            [self.slides_at, self.opens_at].map(|acceleration| significant(acceleration / gravity, 4));
        if self.opens_at <= 0.0 {
            return format!("interface {interface} opens by itself: the stack above leans beyond its support");
        }
        let Some(at_pga) = self.at_pga else {
            let side = if self.is_symmetric { "" } else { ", to its weaker side," };
            let first = match (self.weightless, self.slides_from, self.opens_from) {
                (Some(t), ..) => format!("it has no weight left at t = {t:.4} s, and flies"),
                (_, None, None) => "neither".into(),
                (_, Some(slides), None) => format!("it slides, at t = {slides:.4} s"),
                (_, Some(slides), Some(opens)) if (slides - opens).abs() <= AT_ONCE => {
                    format!("it passes both at t = {opens:.4} s")
                }
                (_, Some(slides), Some(opens)) if slides < opens => format!("it slides first, at t = {slides:.4} s"),
                (.., Some(opens)) => format!("it opens first, at t = {opens:.4} s"),
            };
            return format!(
                "interface {interface} slides at {slides} g, and opens{side} at {opens} g; under this ground motion {first}"
            );
        };
        if self.slides_at < self.opens_at {
            let both = match at_pga {
                "slides" => "; at the PGA it slides",
                _ => "",
            };
            return format!("interface {interface} slides at {slides} g before it opens at {opens} g{both}");
        }
        let both = self.coefficient_to_rock.map(|needed| {
            let verb = match at_pga {
                "rocks" => "rocks without sliding: that takes",
                "slides" => "slides, and rocks once it sticks: to rock without sliding takes",
                _ => "slides and rocks: to rock without sliding takes",
            };
            let [needed, own] = [needed, *coefficient].map(|coefficient| significant(coefficient, 4));
            format!("; at the PGA it {verb} {needed} (mu_c), and it has {own}")
        });
        format!("interface {interface} opens at {opens} g before it slides at {slides} g{}", both.unwrap_or_default())
    }
}

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
        let horizontal = component(&scene.excitation.horizontal);
        let pga = horizontal.as_ref().map_or(0.0, |motion| motion.pga);
        let (openings, slips) = (scene.openings_at_rest(), scene.slips_at_rest());
        let opened = (1..).zip(&openings).filter(|(_, opening)| opening.is_some());
        let pga_alone = scene.excitation.vertical.is_none().then_some(pga);
        Findings {
            title: scene.title.clone(),
            blocks: column.blocks().to_vec(),
            derived,
            opens: opened.map(|(interface, _)| interface).collect(),
            first_opening: openings.iter().copied().flatten().reduce(f64::min),
            contacts: scene
                .friction
                .iter()
                .flat_map(|friction| {
                    stacks.iter().zip(&openings).zip(&slips).map(|((stack, opens), slides)| {
                        let is_symmetric = offset(column, stack.interface - 1) == 0.0;
                        let gives = [*slides, *opens];
                        let lift = |t: f64| scene.excitation.vertical.as_ref().map_or(0.0, |motion| motion.value(t));
                        let weightless = slides.filter(|t| {
                            opens.is_some_and(|opens| (t - opens).abs() <= AT_ONCE)
                                && lift(*t) <= -column.gravity() * (1.0 - WEIGHTLESS)
                        });
                        ContactFindings {
                            weightless,
                            ..ContactFindings::of(stack, friction, pga_alone, is_symmetric, gives)
                        }
                    })
                })
                .collect(),
            openings,
            stacks,
            restitution_factors: scene.restitution.factors(column),
            horizontal,
            vertical: component(&scene.excitation.vertical),
            initial: scene.initial.clone(),
            slides: column.slides().to_vec(),
            method: scene.options.method.stepper().name(),
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
        let is_displaced = |interface: usize| {
            column.centroid_offset(interface).abs() > ROUNDING_OF_RATIOS * column.contact_half_width(interface)
        };
        if (0..column.len()).any(is_displaced) {
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
            let _ = writeln!(text, "  {}", contact.text(gravity));
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

    /// A clause on the interface that slides before any opens; empty if none does.
    fn slip_before_opening(&self) -> String {
        let slips = self.contacts.iter().filter_map(|contact| Some((contact.slides_from?, contact.interface)));
        let first = slips.min_by(|(t, _), (other, _)| t.total_cmp(other));
        match first.filter(|(t, _)| self.first_opening.is_some_and(|opening| *t < opening)) {
            Some((t, interface)) => {
                format!("; interface {interface} slides before, at t = {t:.4} s, and may keep all of them closed")
            }
            None => String::new(),
        }
    }

    /// Which interfaces the ground motion opens of the column at rest.
    fn openings(&self, text: &mut String, scene: &Scene) {
        let gravity = scene.column.gravity();
        let lowest = self.stacks.iter().map(|stack| stack.uplift_acceleration).fold(f64::INFINITY, f64::min).max(0.0);
        let interfaces = self.opens.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
        let _ = match (&self.horizontal, &self.vertical) {
            (None, None) => Ok(()),
            (horizontal, Some(_)) => {
                let motion = if horizontal.is_some() { "with the vertical motion it" } else { "it" };
                match self.first_opening {
                    Some(t) => writeln!(
                        text,
                        "  {motion} opens interface(s) {interfaces} of the column at rest, the first at t = {t:.4} s{}",
                        self.slip_before_opening()
                    ),
                    None => writeln!(text, "  {motion} opens no interface of the column at rest"),
                }
            }
            (Some(motion), None) => {
                let [pga, lowest] = [motion.pga, lowest].map(|acceleration| acceleration / gravity);
                let is_displaced = scene.column.slides().iter().any(|slide| *slide != 0.0);
                let weaker = if is_displaced { " towards its weaker side" } else { "" };
                let first = first_threshold(&scene.column, &motion.motion, &self.openings);
                let is_first = |stack: &thresholds::Row| self.openings[stack.interface - 1] == self.first_opening;
                let is_leaning = self.stacks.iter().any(|stack| stack.uplift_acceleration <= 0.0 && is_first(stack));
                if let Some(t) = self.first_opening.filter(|_| is_leaning) {
                    let _ = writeln!(
                        text,
                        "  interface(s) {interfaces} of the column at rest open, the first at t = {t:.4} s: a stack that leans beyond its support, which the ground does not hold then{}",
                        self.slip_before_opening()
                    );
                    return;
                }
                match &*interfaces {
                    "" if is_displaced && pga >= lowest => writeln!(
                        text,
                        "  {pga:.4} g opens no interface of the column at rest: the peak acts towards its stronger side; towards the weaker one {lowest:.4} g is enough"
                    ),
                    "" => writeln!(
                        text,
                        "  {pga:.4} g opens no interface of the column at rest, which takes {lowest:.4} g{weaker}"
                    ),
                    _ => writeln!(
                        text,
                        "  {pga:.4} g is enough to open interface(s) {interfaces} of the column at rest{}{}",
                        first.map_or_else(String::new, |(threshold, side)| {
                            let threshold = threshold / gravity;
                            let least = match lowest < threshold * (1.0 - 1e-9) {
                                true => format!("; the least that opens one, to its weaker side, is {lowest:.4} g"),
                                false => String::new(),
                            };
                            format!("; the first opens at {threshold:.4} g{side}{least}")
                        }),
                        self.slip_before_opening()
                    ),
                }
            }
        };
    }
}

/// Offset of the stack's centre of gravity from the middle of the contact `[m]`; zero where it is rounding of a slide.
fn offset(column: &Column, interface: usize) -> f64 {
    let offset = column.centroid_offset(interface);
    if offset.abs() <= ROUNDING_OF_RATIOS * column.contact_half_width(interface) { 0.0 } else { offset }
}

/// The horizontal ground acceleration at which the interface that a motion opens first begins to open `[m/s²]`, and the side to which it does where both sides
/// differ: of several that open at once, the one that takes least. `openings`: when each interface opens `[s]`. `None` if none does.
fn first_threshold(column: &Column, motion: &Motion, openings: &[Option<f64>]) -> Option<(f64, &'static str)> {
    let threshold = |(interface, t): (usize, &Option<f64>)| {
        let t = (*t)?;
        let (offset, push) = (offset(column, interface), motion.value(t));
        // A ground that accelerates to the right tips the blocks to the left. Without a push only a stack that leans beyond its support opens, to its
        // weaker side.
        let nearer = if push == 0.0 { offset.abs() } else { -offset * push.signum() };
        let lever = column.contact_half_width(interface) - nearer;
        let side = match nearer {
            0.0 => "",
            nearer if nearer > 0.0 => " towards its weaker side",
            _ => " towards its stronger side",
        };
        Some((t, (column.gravity() * lever / column.centroid_height(interface)).max(0.0), side))
    };
    let first = openings.iter().enumerate().filter_map(threshold);
    let first =
        first.min_by(|(t, size, _), (other, other_size, _)| t.total_cmp(other).then(size.total_cmp(other_size)));
    first.map(|(_, size, side)| (size, side))
}

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
        let _ = writeln!(text, "  ends at {end:.4} s; the ground is left {left}");
        // Zeros at the end of a record are no motion.
        if self.motion.moves_after(t_end) {
            let _ = writeln!(text, "  note: that is after the end of the run, solver.t_end");
        }
    }
}
