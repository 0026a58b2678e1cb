//! Scenes that several modules take.

/// One block with friction under a pulse that rocks it.
pub const SCENE: &str = "title = \"one block\"
friction = 0.8
[[block]]
half_width = 0.4
half_height = 1.6
[excitation.horizontal]
kind = \"sine-pulse\"
amplitude = 4.0
omega = 10.0
[solver]
t_end = 2.0
";

/// Housner's block; the keys of its horizontal ground motion follow.
pub const BLOCK: &str = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n[excitation.horizontal]\n";

/// A record that shakes strongly after 12 s.
pub const LATE: &str = "kind = \"record\"\ndt = 0.5\naccel = [0, 1, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, \
    6, 0, -6, 0, 0, 0]\n";

/// A pulse that overturns it, as in textbooks.
pub const OVERTURNS: &str = "kind = \"sine-pulse\"\namplitude_uplift = 4\nomega_p = 5.0\n";
