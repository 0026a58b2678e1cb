//! The column: rigid blocks on one axis, base first, validated, in SI units.

use serde::{Deserialize, Serialize};

/// One rigid block. SI; masses may be per unit thickness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Half of its width `[m]`.
    pub half_width: f64,
    /// Half of its height `[m]`; the centroid is at mid-height.
    pub half_height: f64,
    /// `[kg]`
    pub mass: f64,
    /// Centroidal moment of inertia `[kg m²]`.
    pub inertia: f64,
}

impl Block {
    /// A homogeneous rectangle of this density `[kg/m²]`: `m = 4 ρ b h`, `I = m (b² + h²) / 3`.
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

    /// A homogeneous rectangle of this mass `[kg]`.
    pub fn with_mass(half_width: f64, half_height: f64, mass: f64) -> Block {
        let inertia = mass * (half_width * half_width + half_height * half_height) / 3.0;
        Block { half_width, half_height, mass, inertia }
    }
}

/// A stack of blocks in a gravity field, base first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Column {
    blocks: Vec<Block>,
    gravity: f64,
}

/// A column as it is read, before [`Column::new`].
#[derive(Deserialize)]
struct Unchecked {
    blocks: Vec<Block>,
    gravity: f64,
}

impl TryFrom<Unchecked> for Column {
    type Error = ColumnError;

    fn try_from(Unchecked { blocks, gravity }: Unchecked) -> Result<Column, ColumnError> {
        Column::new(blocks, gravity)
    }
}

/// Why a column is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColumnError {
    /// There is nothing to rock.
    #[error("a column needs at least one block")]
    Empty,
    /// A size, mass or inertia that no body has.
    #[error("block {block} (from the base): {quantity} = {value} must be a finite number above zero")]
    NotPositive {
        /// From 1, base first.
        block: usize,
        /// Which one.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// Gravity must hold the column down.
    #[error("gravity = {value} must be a finite number above zero (m/s²)")]
    Gravity {
        /// What was given.
        value: f64,
    },
}

impl Column {
    /// A column of these blocks, base first, under `gravity [m/s²]`.
    ///
    /// # Errors
    /// [`ColumnError`] if there is no block, or a number is not finite and above zero.
    pub fn new(blocks: Vec<Block>, gravity: f64) -> Result<Column, ColumnError> {
        if blocks.is_empty() {
            return Err(ColumnError::Empty);
        }
        for (index, block) in blocks.iter().enumerate() {
            let quantities = [
                ("half_width", block.half_width),
                ("half_height", block.half_height),
                ("mass", block.mass),
                ("inertia", block.inertia),
            ];
            if let Some(&(quantity, value)) = quantities.iter().find(|(_, v)| !(v.is_finite() && *v > 0.0)) {
                return Err(ColumnError::NotPositive { block: index + 1, quantity, value });
            }
        }
        if !(gravity.is_finite() && gravity > 0.0) {
            return Err(ColumnError::Gravity { value: gravity });
        }
        Ok(Column { blocks, gravity })
    }

    /// `count` equal rectangles that together are `half_width` and `half_height` (of the whole) in half-size `[m]`.
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

    /// Never: a column has at least one block.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// `[m/s²]`
    pub fn gravity(&self) -> f64 {
        self.gravity
    }

    /// Contact half-width `c_i [m]` of an interface, from zero: `c_1 = b_1`, `c_i = min(b_{i-1}, b_i)`.
    pub fn contact_half_width(&self, interface: usize) -> f64 {
        let own = self.blocks[interface].half_width;
        if interface == 0 { own } else { own.min(self.blocks[interface - 1].half_width) }
    }

    /// Mass of the stack above an interface, from zero `[kg]`.
    pub fn mass_above(&self, interface: usize) -> f64 {
        self.blocks[interface..].iter().map(|block| block.mass).sum()
    }

    /// Height `h_Pi [m]` of the centre of gravity of the stack above an interface (from zero) above that interface.
    pub fn centroid_height(&self, interface: usize) -> f64 {
        let mut base = 0.0;
        let mut moment = 0.0;
        for block in &self.blocks[interface..] {
            moment += block.mass * (base + block.half_height);
            base += 2.0 * block.half_height;
        }
        moment / self.mass_above(interface)
    }

    /// The blocks above an interface (from zero) as one body; that above interface 0 is the whole column.
    pub fn stack(&self, interface: usize) -> Stack {
        let half_width = self.contact_half_width(interface);
        let mut base = 0.0;
        let mut inertia = 0.0;
        for block in &self.blocks[interface..] {
            let height = base + block.half_height;
            inertia += block.inertia + block.mass * (half_width * half_width + height * height);
            base += 2.0 * block.half_height;
        }
        Stack {
            mass: self.mass_above(interface),
            height: base,
            half_width,
            centroid_height: self.centroid_height(interface),
            inertia,
            gravity: self.gravity,
        }
    }

    /// Horizontal ground acceleration `[m/s²]` at which the interface (from zero) of the column at rest opens:
    /// `c_i g / h_Pi` (docs/book/model.md, section 4, the paper's Eq. 1).
    pub fn uplift_acceleration(&self, interface: usize) -> f64 {
        self.stack(interface).uplift_acceleration()
    }

    /// Slenderness `α` of the whole column `[rad]`; see [`Stack::slenderness`].
    pub fn slenderness(&self) -> f64 {
        self.stack(0).slenderness()
    }

    /// Moment of inertia `I_O [kg m²]` of the whole column as one body about a corner of its base.
    pub fn inertia_about_corner(&self) -> f64 {
        self.stack(0).inertia
    }

    /// Housner's ratio `ω⁺/ω⁻` of the whole column as one body; see [`Stack::housner_ratio`].
    pub fn housner_ratio(&self) -> f64 {
        self.stack(0).housner_ratio()
    }
}

/// The blocks above an interface as one body that rocks on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stack {
    /// `[kg]`
    pub mass: f64,
    /// From the interface to the top `[m]`.
    pub height: f64,
    /// Half-width `c_i` of the contact below `[m]`.
    pub half_width: f64,
    /// Height `h_Pi` of the centre of gravity above the contact `[m]`.
    pub centroid_height: f64,
    /// Moment of inertia `I_O` about a corner of the contact `[kg m²]`.
    pub inertia: f64,
    /// `[m/s²]`
    pub gravity: f64,
}

impl Stack {
    /// `α = atan(c / h_P)` `[rad]`
    pub fn slenderness(&self) -> f64 {
        libm::atan2(self.half_width, self.centroid_height)
    }

    /// Distance `R` of the centre of gravity from a corner `[m]`.
    pub fn radius(&self) -> f64 {
        libm::hypot(self.half_width, self.centroid_height)
    }

    /// Frequency parameter `p = √(m g R / I_O)` `[rad/s]`; for one homogeneous rectangle `√(3 g / (4 R))`. Housner (1963).
    pub fn frequency_parameter(&self) -> f64 {
        (self.mass * self.gravity * self.radius() / self.inertia).sqrt()
    }

    /// Horizontal ground acceleration at which it opens from rest, `c g / h_P` `[m/s²]` (docs/book/model.md, section 4).
    pub fn uplift_acceleration(&self) -> f64 {
        self.half_width * self.gravity / self.centroid_height
    }

    /// Housner's ratio `ω⁺/ω⁻` of an impact, `1 - 2 m c² / I_O`; for one homogeneous rectangle `1 - 3/2 sin² α`.
    pub fn housner_ratio(&self) -> f64 {
        1.0 - 2.0 * self.mass * self.half_width * self.half_width / self.inertia
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
}
