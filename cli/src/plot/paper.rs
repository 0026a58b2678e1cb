//! The paper of a figure: its printed width, the unit of angles, and the file format.

use clap::ValueEnum;
use std::path::Path;

/// Pixels of a sheet per millimetre of paper: 720 px on 15 cm, where text of 14 px has 8 pt.
const PX_PER_MM: f64 = 720.0 / 150.0;

/// Default width of sheets `[px]`: narrow, so that text is large in a printed column or on a phone.
const WIDTH: f64 = 720.0;

/// How figures are laid out. Text keeps its size on paper of any width.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paper {
    /// Printed width `[mm]`. If `None`, the figure is laid out for 15 cm and scales to the page on which it stands.
    pub width_mm: Option<f64>,
    /// Unit of angles.
    pub angles: Angles,
}

/// Units of angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Angles {
    /// Angles are divided by the slenderness. The slenderness itself and phase portraits are in rad.
    #[default]
    Natural,
    /// In degrees.
    Degrees,
}

/// Smallest and largest width of paper `[mm]`: on narrower paper legends and panels have no room, and no printed page is wider.
pub const WIDTHS_MM: [f64; 2] = [80.0, 500.0];

impl Paper {
    /// Width of its sheets `[px]`.
    pub fn width(&self) -> f64 {
        self.width_mm.map_or(WIDTH, |width| (width * PX_PER_MM).round())
    }

    /// Points (1/72 inch) for a pixel of its sheets.
    #[cfg(feature = "pdf")]
    pub fn points_per_px(&self) -> f64 {
        72.0 / 25.4 / PX_PER_MM
    }

    /// An angle `[rad]` in words, with its unit.
    pub fn angle(&self, angle: f64) -> String {
        match self.angles {
            Angles::Natural => format!("{} rad", super::axis::brief(angle)),
            Angles::Degrees => format!("{}°", super::axis::brief(angle.to_degrees())),
        }
    }
}

/// How a figure is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Picture {
    /// To be scaled at will.
    Svg,
    /// In pixels.
    Png,
    /// To be printed.
    #[cfg(feature = "pdf")]
    Pdf,
}

impl Picture {
    /// The end of a file's name.
    pub fn extension(self) -> &'static str {
        match self {
            Picture::Svg => "svg",
            Picture::Png => "png",
            #[cfg(feature = "pdf")]
            Picture::Pdf => "pdf",
        }
    }

    /// Format given by the extension of a file; `None` for any other extension.
    pub fn of(file: &Path) -> Option<Picture> {
        let extension = file.extension()?;
        Picture::value_variants().iter().copied().find(|picture| extension.eq_ignore_ascii_case(picture.extension()))
    }
}
