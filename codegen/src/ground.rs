//! How the ground moves.

/// Components of the ground motion. A program for horizontal motion only has no terms of vertical motion, and so costs less.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GroundMotion {
    /// Horizontal motion only: gravity is a scene constant.
    Horizontal,
    /// Horizontal and vertical motion: gravity changes with time.
    WithVertical,
}

impl GroundMotion {
    /// Both variants, in the order of the arrays that are kept per ground motion.
    pub const ALL: [GroundMotion; 2] = [GroundMotion::Horizontal, GroundMotion::WithVertical];
}
