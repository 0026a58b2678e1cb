//! The column: rigid blocks, base first, on one axis or displaced sideways by slides; validated, in SI units.

use crate::numerics::plane::plus;
use rocking_codegen::pattern::Interface;
use serde::{Deserialize, Serialize};

/// One rigid block, symmetric about its axis. SI; masses may be per unit thickness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Half of the width of its base `[m]`.
    pub bottom_half_width: f64,
    /// Half of the width of its top face `[m]`.
    pub top_half_width: f64,
    /// Half of its height `[m]`.
    pub half_height: f64,
    /// Height of the centroid above the base, on the axis `[m]`.
    pub centroid_height: f64,
    /// `[kg]`
    pub mass: f64,
    /// Centroidal moment of inertia `[kg m²]`.
    pub inertia: f64,
}

impl Block {
    /// A homogeneous rectangle of half-width `b [m]`, half-height `h [m]` and density `ρ [kg/m²]`: `m = 4 ρ b h`, `I = m (b² + h²) / 3`.
    ///
    /// ```
    /// let block = rocking::Block::rectangle(0.4, 1.0, 2.0);
    /// assert_eq!(block.mass, 3.2);
    /// assert!((block.inertia - 3.2 * 1.16 / 3.0).abs() < 1e-15);
    /// ```
    pub fn rectangle(half_width: f64, half_height: f64, density: f64) -> Block {
        let mass = 4.0 * density * half_width * half_height;
        Block::with_mass(half_width, half_height, mass)
    }

    /// A homogeneous rectangle of half-width `[m]`, half-height `[m]` and mass `[kg]`.
    pub fn with_mass(half_width: f64, half_height: f64, mass: f64) -> Block {
        Block::of_shape(Shape::Prism, [half_width; 2], half_height, mass)
    }

    /// Homogeneous body of half-widths `[m]` of base and top, half-height `[m]` and mass `[kg]`: density times [`Shape::measure`]. A block keeps no shape, and
    /// is drawn as a prism unless [`Scene::looks`](crate::Scene::looks) say otherwise.
    ///
    /// With half-widths `a`, `b`, full height `H`, centroid `e` above the base and inertia `I` about it (docs/book/model.md, section 1),
    ///
    /// ```text
    /// prism:   e = H (a + 2b) / 3(a + b),       I = m ((a² + b²)/6 + H² (a² + 4ab + b²) / 18(a + b)²)
    /// drum:    e = H (a² + 2ab + 3b²) / 4 s₂,   I = m (3 s₄ / 20 s₂ + 3 H² (a⁴ + 4a³b + 10a²b² + 4ab³ + b⁴) / 80 s₂²)
    ///          s₂ = a² + ab + b²,               s₄ = a⁴ + a³b + a²b² + ab³ + b⁴
    /// ```
    ///
    /// ```
    /// use rocking::{Block, column::Shape};
    /// let drum = Block::of_shape(Shape::Drum, [0.5, 0.5], 0.4, 100.0);
    /// assert!((drum.inertia - 100.0 * (3.0 * 0.25 + 0.64) / 12.0).abs() < 1e-13);
    /// assert!((Block::of_shape(Shape::Prism, [0.5, 0.0], 0.3, 1.0).centroid_height - 0.2).abs() < 1e-16);
    /// ```
    pub fn of_shape(shape: Shape, [bottom, top]: [f64; 2], half_height: f64, mass: f64) -> Block {
        let (a, b, height) = (bottom, top, 2.0 * half_height);
        let (centroid_height, inertia) = match shape {
            Shape::Prism if a == b => (half_height, mass * (a * a + half_height * half_height) / 3.0),
            Shape::Prism => {
                let sum = a + b;
                let across = (a * a + b * b) / 6.0;
                let along = height * height * (a * a + 4.0 * a * b + b * b) / (18.0 * sum * sum);
                (height * (a + 2.0 * b) / (3.0 * sum), mass * (across + along))
            }
            Shape::Drum if a == b => (half_height, mass * (3.0 * a * a + height * height) / 12.0),
            Shape::Drum => {
                let (squares, fourth) = (a * a + a * b + b * b, |x: f64, y: f64| x * x * x * x + x * x * x * y);
                let across = 3.0 * (fourth(a, b) + a * a * b * b + fourth(b, a)) / (20.0 * squares);
                let moments =
                    a * a * a * a + 4.0 * a * a * a * b + 10.0 * a * a * b * b + 4.0 * a * b * b * b + b * b * b * b;
                let along = 3.0 * height * height * moments / (80.0 * squares * squares);
                (height * (a * a + 2.0 * a * b + 3.0 * b * b) / (4.0 * squares), mass * (across + along))
            }
        };
        Block { bottom_half_width: a, top_half_width: b, half_height, centroid_height, mass, inertia }
    }

    /// Half of the largest width `[m]`.
    pub fn half_width(&self) -> f64 {
        self.bottom_half_width.max(self.top_half_width)
    }

    /// Whether base and top are equally wide and the centroid is at mid-height.
    pub fn is_rectangular(&self) -> bool {
        self.bottom_half_width == self.top_half_width && self.centroid_height == self.half_height
    }
}

/// The solid of which a block is the side view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// The same trapezoid at every depth.
    #[default]
    Prism,
    /// A cylinder or frustum: half-widths are radii.
    Drum,
}

impl Shape {
    /// Measure of the body with these half-widths `[m]` of base and top and this half-height `[m]`: the area of a prism's side `[m²]`,
    /// the volume of a drum `[m³]`.
    ///
    /// ```
    /// use rocking::column::Shape;
    /// assert!((Shape::Drum.measure([0.5, 0.5], 0.4) - std::f64::consts::PI * 0.25 * 0.8).abs() < 1e-15);
    /// ```
    pub fn measure(self, [bottom, top]: [f64; 2], half_height: f64) -> f64 {
        match self {
            Shape::Prism => 2.0 * (bottom + top) * half_height,
            Shape::Drum => {
                let squares = bottom * bottom + bottom * top + top * top;
                std::f64::consts::PI * squares * 2.0 * half_height / 3.0
            }
        }
    }
}

/// A stack of blocks in a gravity field, base first.
///
/// Blocks may stand displaced: the slide `u_i` of an interface is how far the middle of the block's base is to the right of the middle
/// of the face below. Drawn for `u > 0`, `x⁻` and `x⁺` the ends of the contact:
///
/// ```text
///             .___________.
///             |     |     |
///             |_____|_____|
///       .___________.            contact from x⁻ to x⁺, half-length c, its centre in between
///       |     |     |
///          x⁻ ^     ^ x⁺
/// ```
///
/// Blocks and interfaces count from zero, base first. Methods that take the number of one panic if the column does not have it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Column {
    blocks: Vec<Block>,
    gravity: f64,
    /// Slides `u_i [m]`, base first, length N.
    slides: Vec<f64>,
    #[serde(skip)]
    seats: Vec<Seat>,
    /// The blocks above each interface, base first, length N.
    #[serde(skip)]
    stacks: Vec<Above>,
}

/// The blocks above an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Above {
    stack: Stack,
    /// How far the centre of gravity is to the right of the centre of the contact `[m]`.
    offset: f64,
}

/// How a block sits on what is below it: lengths along the block's axes `[m]`, from the centre of the contact below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seat {
    /// Half-length `c_i` of the contact below.
    pub half_width: f64,
    /// Centre of the contact below, from the middle of the face below.
    pub on_lower: f64,
    /// Centroid.
    pub centroid: [f64; 2],
    /// Centre of the contact above; of the top block, the middle of the top face.
    pub top: [f64; 2],
}

/// A column as it is read from a file, before [`Column::new`] and [`Column::displaced`] check it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked {
    blocks: Vec<Block>,
    gravity: f64,
    slides: Vec<f64>,
}

impl TryFrom<Unchecked> for Column {
    type Error = ColumnError;

    fn try_from(Unchecked { blocks, gravity, slides }: Unchecked) -> Result<Column, ColumnError> {
        Column::new(blocks, gravity)?.displaced(slides)
    }
}

/// Why a column is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColumnError {
    /// There is no block.
    #[error("a column needs at least one block")]
    Empty,
    /// A size, mass or inertia that is not a finite number above zero.
    #[error("block {block} (from the base): {quantity} = {value} must be a finite number above zero")]
    NotPositive {
        /// From 1, base first.
        block: usize,
        /// Name of the quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// A half-width of a face, or a height of a centroid, that is out of range.
    #[error("block {block} (from the base): {quantity} = {value} {problem}")]
    Shape {
        /// From 1, base first.
        block: usize,
        /// Name of the quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// More blocks than a column may have.
    #[error("{blocks} blocks are more than the {MOST_BLOCKS} that a column may have")]
    TooMany {
        /// What was given.
        blocks: usize,
    },
    /// The number of slides is not that of the interfaces.
    #[error("{slides} slide(s) for {interfaces} interface(s)")]
    SlideCount {
        /// Slides given.
        slides: usize,
        /// Interfaces of the column.
        interfaces: usize,
    },
    /// A slide that is not finite, or beyond [`LARGEST_SLIDE`].
    #[error("slide {value:e} m at interface {interface} is out of range")]
    Slide {
        /// From 1, base first.
        interface: usize,
        /// What was given `[m]`.
        value: f64,
    },
    /// A block that does not stand on the one below.
    #[error("a slide of {slide} m puts block {interface} off its support, which ends at {limit} m")]
    OffSupport {
        /// From 1, base first.
        interface: usize,
        /// What was given `[m]`.
        slide: f64,
        /// Magnitude of the slide at which the contact's length is zero `[m]`.
        limit: f64,
    },
    /// Gravity that is not a finite number above zero.
    #[error("gravity = {value} must be a finite number above zero (m/s²)")]
    Gravity {
        /// What was given.
        value: f64,
    },
}

/// Largest number of blocks of a column: a larger one is taken for a mistake.
pub const MOST_BLOCKS: usize = 100;

/// Largest slide `[m]`: beyond it, places of blocks lose digits that their motion needs.
pub const LARGEST_SLIDE: f64 = 1e6;

impl Column {
    /// A column of these blocks, base first, under `gravity [m/s²]`.
    ///
    /// # Errors
    /// [`ColumnError`] if there is no block, or more than [`MOST_BLOCKS`]; if a number is not finite or not above zero (the top of the top block may be an
    /// edge, of no width); if a centroid is outside its block.
    pub fn new(blocks: Vec<Block>, gravity: f64) -> Result<Column, ColumnError> {
        if blocks.is_empty() {
            return Err(ColumnError::Empty);
        }
        if blocks.len() > MOST_BLOCKS {
            return Err(ColumnError::TooMany { blocks: blocks.len() });
        }
        for (index, block) in blocks.iter().enumerate() {
            // Masses and inertias may follow from the sizes: these are named first.
            let quantities = [
                ("half_width", block.half_width()),
                ("half_height", block.half_height),
                ("mass", block.mass),
                ("inertia", block.inertia),
            ];
            if let Some(&(quantity, value)) = quantities.iter().find(|(_, v)| !(v.is_finite() && *v > 0.0)) {
                return Err(ColumnError::NotPositive { block: index + 1, quantity, value });
            }
            let wrong =
                |quantity, value, problem| Err(ColumnError::Shape { block: index + 1, quantity, value, problem });
            let faces = [("bottom_half_width", block.bottom_half_width), ("top_half_width", block.top_half_width)];
            // A block may end in an edge where nothing stands on it.
            let is_last = index + 1 == blocks.len();
            for (quantity, value) in faces {
                let may_be_zero = is_last && quantity == "top_half_width";
                if !(value.is_finite() && (value > 0.0 || value == 0.0 && may_be_zero)) {
                    return wrong(quantity, value, "leaves no width to stand on");
                }
            }
            let height = 2.0 * block.half_height;
            if !(block.centroid_height > 0.0 && block.centroid_height < height) {
                return wrong("centroid_height", block.centroid_height, "is not inside the block");
            }
        }
        if !(gravity.is_finite() && gravity > 0.0) {
            return Err(ColumnError::Gravity { value: gravity });
        }
        let slides = vec![0.0; blocks.len()];
        let seats = seats(&blocks, &slides)?;
        let stacks = stacks(&blocks, &seats, gravity);
        Ok(Column { blocks, gravity, slides, seats, stacks })
    }

    /// The column with its blocks displaced by these slides `u_i [m]`, base first, length N: block `i` stands `u_i` to the right of the
    /// block below, the lowest block `u_1` to the right of the origin on the ground.
    ///
    /// ```
    /// let column = rocking::Column::equal_blocks(2, 0.4, 1.6, 1.0, 9.81)?.displaced(vec![0.0, 0.1])?;
    /// assert!((column.contact_half_width(1) - 0.35).abs() < 1e-15);
    /// // The contact reaches from -0.3 m to 0.4 m: its centre is 0.05 m to the left of the upper block's axis.
    /// assert!((column.centroid_offset(1) - 0.05).abs() < 1e-15);
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    ///
    /// # Errors
    /// [`ColumnError`] if there are more or fewer slides than blocks, one is not finite or beyond [`LARGEST_SLIDE`], or a block is off its support.
    pub fn displaced(self, slides: Vec<f64>) -> Result<Column, ColumnError> {
        if let Some(index) = slides.iter().position(|slide| slide.abs() > LARGEST_SLIDE) {
            return Err(ColumnError::Slide { interface: index + 1, value: slides[index] });
        }
        self.slid(slides)
    }

    /// As [`Column::displaced`], with the slides of a run, which have no bound.
    pub(crate) fn slid(mut self, slides: Vec<f64>) -> Result<Column, ColumnError> {
        if slides.len() != self.blocks.len() {
            return Err(ColumnError::SlideCount { slides: slides.len(), interfaces: self.blocks.len() });
        }
        self.seats = seats(&self.blocks, &slides)?;
        self.stacks = stacks(&self.blocks, &self.seats, self.gravity);
        self.slides = slides;
        Ok(self)
    }

    /// `count` equal rectangles of this density `[kg/m²]`. `half_width` and `half_height` are those of the whole column `[m]`.
    ///
    /// # Errors
    /// As [`Column::new`].
    pub fn equal_blocks(
        count: usize,
        half_width: f64,
        half_height: f64,
        density: f64,
        gravity: f64,
    ) -> Result<Column, ColumnError> {
        if count > MOST_BLOCKS {
            return Err(ColumnError::TooMany { blocks: count });
        }
        Column::new(vec![Block::rectangle(half_width, half_height / count as f64, density); count], gravity)
    }

    /// The blocks, base first.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Number of blocks N, which is also the number of interfaces.
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Always `false`: a column has at least one block.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Length scale of the column `[m]`: largest sum of half-height and half-width of a block.
    pub(crate) fn size(&self) -> f64 {
        self.blocks.iter().fold(0.0, |size, block| size.max(block.half_height + block.half_width()))
    }

    /// Mass of all blocks `[kg]`.
    pub(crate) fn mass(&self) -> f64 {
        self.blocks.iter().map(|block| block.mass).sum()
    }

    /// `[m/s²]`
    pub fn gravity(&self) -> f64 {
        self.gravity
    }

    /// Slides `u_i [m]`, base first, length N.
    pub fn slides(&self) -> &[f64] {
        &self.slides
    }

    /// Contact half-width `c_i [m]` of an interface, from zero: half of the length over which its faces overlap. For aligned blocks `c_1 = b_1`,
    /// `c_i = min(b_{i-1}, b_i)`.
    pub fn contact_half_width(&self, interface: usize) -> f64 {
        self.seats[interface].half_width
    }

    /// Place of the corner about which an interface in this state opens, to the right of the contact's centre `[m]`; zero for a closed one.
    #[inline]
    pub(crate) fn pivot_offset(&self, interface: usize, state: Interface) -> f64 {
        f64::from(state.sign()) * self.contact_half_width(interface)
    }

    /// Half-width of the face below an interface `[m]`; infinite on the ground.
    #[inline]
    pub(crate) fn lower_half_width(&self, interface: usize) -> f64 {
        interface.checked_sub(1).map_or(f64::INFINITY, |below| self.blocks[below].top_half_width)
    }

    /// Ends `[x⁻, x⁺] [m]` of the contact at an interface (from zero), from the middle of the face below.
    pub fn contact(&self, interface: usize) -> [f64; 2] {
        let Seat { half_width, on_lower, .. } = self.seats[interface];
        [on_lower - half_width, on_lower + half_width]
    }

    /// How the blocks sit on each other, base first, length N.
    #[inline(always)]
    pub(crate) fn seats(&self) -> &[Seat] {
        &self.seats
    }

    /// Whether every contact is centred on both of its faces and every centroid at mid-height: the equations of such columns have fewer
    /// constants.
    pub(crate) fn is_plain(&self) -> bool {
        let is_top = |index: usize| index + 1 == self.len();
        let has_plain_seat = |(index, (seat, block)): (usize, (&Seat, &Block))| {
            seat.centroid == [0.0, block.half_height] && (seat.top[0] == 0.0 || is_top(index))
        };
        self.seats.iter().zip(&self.blocks).enumerate().all(has_plain_seat)
    }

    /// Mass of the stack above an interface, from zero `[kg]`.
    pub fn mass_above(&self, interface: usize) -> f64 {
        self.stacks[interface].stack.mass
    }

    /// Height `h_Pi [m]` of the centre of gravity of the stack above an interface (from zero) above that interface.
    pub fn centroid_height(&self, interface: usize) -> f64 {
        self.stacks[interface].stack.centroid_height
    }

    /// How far the centre of gravity of the stack above an interface (from zero) is to the right of the centre of the contact `[m]`:
    /// zero for aligned blocks.
    pub fn centroid_offset(&self, interface: usize) -> f64 {
        self.stacks[interface].offset
    }

    /// The blocks above an interface (from zero) as one body; the stack above interface 0 is the whole column.
    pub fn stack(&self, interface: usize) -> Stack {
        self.stacks[interface].stack
    }

    /// The largest frequency parameter `p` of the stacks `[rad/s]`.
    pub(crate) fn largest_frequency_parameter(&self) -> f64 {
        (0..self.len()).map(|interface| self.stack(interface).frequency_parameter()).fold(0.0, f64::max)
    }

    /// Horizontal ground acceleration `[m/s²]` at which the interface (from zero) of the column at rest opens:
    /// `c_i g / h_Pi` for aligned blocks (docs/book/model.md, section 4, the paper's Eq. 1).
    pub fn uplift_acceleration(&self, interface: usize) -> f64 {
        self.stack(interface).uplift_acceleration()
    }

    /// Slenderness `α` of the whole column `[rad]`; see [`Stack::slenderness`].
    pub fn slenderness(&self) -> f64 {
        self.stack(0).slenderness()
    }

    /// Housner's ratio `ω⁺/ω⁻` of the whole column as one body; see [`Stack::housner_ratio`].
    pub fn housner_ratio(&self) -> f64 {
        self.stack(0).housner_ratio()
    }
}

/// The seats of the blocks with these slides.
fn seats(blocks: &[Block], slides: &[f64]) -> Result<Vec<Seat>, ColumnError> {
    // Half-length of each contact, and its centre from the middle of the face below.
    let mut centres = Vec::with_capacity(blocks.len());
    for (index, (block, &slide)) in blocks.iter().zip(slides).enumerate() {
        let own = block.bottom_half_width;
        if !slide.is_finite() {
            return Err(ColumnError::Slide { interface: index + 1, value: slide });
        }
        // The ground is unbounded: the lowest block stands on all of its base.
        let (half_width, on_lower) = match index.checked_sub(1).map(|below| blocks[below].top_half_width) {
            None => (own, slide),
            Some(face) => {
                let [left, right] = [(-face).max(slide - own), face.min(slide + own)];
                (0.5 * (right - left), 0.5 * (left + right))
            }
        };
        if half_width <= 0.0 {
            let limit = own + blocks[index - 1].top_half_width;
            return Err(ColumnError::OffSupport { interface: index + 1, slide, limit });
        }
        centres.push((half_width, on_lower));
    }
    let seat = |(index, block): (usize, &Block)| {
        let (half_width, on_lower) = centres[index];
        // From the centre of the contact below to the block's axis.
        let to_axis = slides[index] - on_lower;
        let above = centres.get(index + 1).map_or(0.0, |(_, on_lower)| *on_lower);
        let (centroid, top) = ([to_axis, block.centroid_height], [to_axis + above, 2.0 * block.half_height]);
        Seat { half_width, on_lower, centroid, top }
    };
    Ok(blocks.iter().enumerate().map(seat).collect())
}

/// The blocks above each interface, base first.
fn stacks(blocks: &[Block], seats: &[Seat], gravity: f64) -> Vec<Above> {
    let above = |interface: usize| {
        let parts = || blocks.iter().zip(seats).skip(interface);
        let mass: f64 = blocks[interface..].iter().map(|block| block.mass).sum();
        // First moment about the centre of the contact `[kg m]`.
        let (mut place, mut moment) = ([0.0, 0.0], [0.0, 0.0]);
        for (block, seat) in parts() {
            for axis in 0..2 {
                moment[axis] += block.mass * (place[axis] + seat.centroid[axis]);
                place[axis] += seat.top[axis];
            }
        }
        let (contact, offset) = (seats[interface].half_width, moment[0] / mass);
        let near = f64::copysign(contact, offset);
        let (mut base, mut inertia) = ([0.0, 0.0], 0.0);
        for (block, seat) in parts() {
            let lever = near - (base[0] + seat.centroid[0]);
            let height = base[1] + seat.centroid[1];
            inertia += block.inertia + block.mass * (lever * lever + height * height);
            base = plus(base, seat.top);
        }
        let stack = Stack {
            mass,
            height: base[1],
            half_width: contact - offset.abs(),
            contact_half_width: contact,
            centroid_height: moment[1] / mass,
            inertia,
            gravity,
        };
        Above { stack, offset }
    };
    (0..blocks.len()).map(above).collect()
}

/// The blocks above an interface as one body that rocks on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stack {
    /// `[kg]`
    pub mass: f64,
    /// From the interface to the top `[m]`.
    pub height: f64,
    /// Lever of the weight `[m]`: horizontal distance of the centre of gravity from the nearer end of the contact below. It is `c_i` if the
    /// blocks are aligned, and negative if the stack does not stand by itself.
    pub half_width: f64,
    /// Half-width `c_i` of the contact under the stack `[m]`.
    pub contact_half_width: f64,
    /// Height `h_Pi` of the centre of gravity above the contact `[m]`.
    pub centroid_height: f64,
    /// Moment of inertia `I_O` about the nearer end of the contact `[kg m²]`.
    pub inertia: f64,
    /// `[m/s²]`
    pub gravity: f64,
}

impl Stack {
    /// `α = atan(c / h_P)` `[rad]`, with `c` the lever of the weight, [`Self::half_width`].
    pub fn slenderness(&self) -> f64 {
        libm::atan2(self.half_width, self.centroid_height)
    }

    /// Distance `R` of the centre of gravity from the nearer end of the contact `[m]`.
    pub fn radius(&self) -> f64 {
        libm::hypot(self.half_width, self.centroid_height)
    }

    /// Frequency parameter `p = √(m g R / I_O)` `[rad/s]`; for one homogeneous rectangle `√(3 g / (4 R))`. Housner (1963).
    pub fn frequency_parameter(&self) -> f64 {
        (self.mass * self.gravity * self.radius() / self.inertia).sqrt()
    }

    /// Horizontal ground acceleration at which the stack tips from rest, `c g / h_P` `[m/s²]`, with `c` the lever (docs/book/model.md, sections 1 and 4).
    pub fn uplift_acceleration(&self) -> f64 {
        self.half_width * self.gravity / self.centroid_height
    }

    /// Least friction coefficient with which the stack rocks from rest without sliding, under this horizontal acceleration of the ground
    /// `[m/s²]`: `|T|/N` of the body as it begins to pivot about its corner. The acceleration must be large enough to tip the stack. For one
    /// homogeneous rectangle with `t = b/h`, `A = |ẍ_g|/g` the coefficient is `(A (1 + 4t²) + 3t) / (4 + t² + 3At)`.
    ///
    /// ```
    /// let column = rocking::Column::equal_blocks(1, 0.25, 1.0, 1000.0, 9.81)?;
    /// assert!((column.stack(0).coefficient_to_rock(9.81) - 0.41558).abs() < 5e-6);
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    pub fn coefficient_to_rock(&self, acceleration: f64) -> f64 {
        let (c, h, push) = (self.half_width, self.centroid_height, acceleration.abs() / self.gravity);
        // Angular acceleration over gravity.
        let turn = self.mass * (push * h - c) / self.inertia;
        (push - h * turn) / (1.0 + c * turn)
    }

    /// Housner's ratio `ω⁺/ω⁻` of an impact, `1 - 2 m c² / I_O`; for one homogeneous rectangle `1 - 3/2 sin² α`. For displaced blocks, the
    /// centre of gravity is taken to be above the centre of the contact.
    pub fn housner_ratio(&self) -> f64 {
        let (lever, contact) = (self.half_width, self.contact_half_width);
        let inertia = self.inertia + self.mass * (contact * contact - lever * lever);
        1.0 - 2.0 * self.mass * contact * contact / inertia
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_monolith_has_housners_ratio() {
        let column = Column::equal_blocks(3, 0.4, 1.6, 1.0, 9.81).expect("valid");
        let sine = libm::sin(libm::atan2(0.4, 1.6));
        assert!((column.housner_ratio() - (1.0 - 1.5 * sine * sine)).abs() < 1e-15);
        let stack = column.stack(0);
        let p = (0.75 * 9.81 / stack.radius()).sqrt();
        assert!((stack.frequency_parameter() - p).abs() < 1e-15);
        assert!((column.stack(1).height - 2.0 * 1.6 * 2.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn a_capital_wider_than_the_shaft_touches_on_the_shaft() {
        let blocks = vec![Block::rectangle(0.35, 1.4, 1.0), Block::rectangle(0.5, 0.25, 1.0)];
        let column = Column::new(blocks, 9.81).expect("valid");
        assert_eq!(column.contact_half_width(1), 0.35);
    }

    /// Of two blocks 1 m wide and 2 m high the upper one overhangs by 0.2 m. About its centre, each has 5/12 m² of inertia per mass.
    #[test]
    fn housners_ratio_of_a_displaced_stack_has_its_weight_above_the_middle_of_the_contact() {
        let column = Column::new(vec![Block::rectangle(0.5, 1.0, 1.0); 2], 9.81).expect("valid");
        let column = column.displaced(vec![0.0, 0.2]).expect("it stands");
        // Of the upper one, the contact is 0.8 m long. The centre of both is 2 m up, 1 m and 0.1 m from those of the blocks.
        let upper = 1.0 - 2.0 * 0.16 / (5.0 / 12.0 + 0.16 + 1.0);
        let both = 1.0 - 2.0 * 0.25 / (5.0 / 12.0 + 1.01 + 0.25 + 4.0);
        for (interface, expected) in [both, upper].into_iter().enumerate() {
            let found = column.stack(interface).housner_ratio();
            assert!((found - expected).abs() < 1e-15, "{interface}: {found} {expected}");
        }
    }
}
