// Read by the build script and by the library.

/// Half-width and half-height of each drum, base first `[m]`; the last one is a capital.
pub const BLOCKS: [(f64, f64); 3] = [(0.4, 0.55), (0.36, 0.5), (0.48, 0.2)];

/// `[kg/m²]`
pub const DENSITY: f64 = 2700.0;

/// `[m/s²]`
pub const GRAVITY: f64 = 9.81;
