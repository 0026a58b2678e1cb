//! Keys of scene files.

#![allow(dead_code, reason = "types of which only the schema is made")]

use super::motion::Component;
use super::station::Station;
use schemars::JsonSchema;

/// A scene file.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Scene {
    /// printed with results
    #[schemars(extend("x-default" = "empty"))]
    pub title: Option<String>,
    /// gravity; also the size of one g in this scene
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m/s²", "x-default" = "9.81"))]
    pub gravity: Option<f64>,
    /// coefficient of Coulomb friction, from 0 to 1e8, or a table: blocks slide and fly where the forces ask for it
    #[schemars(extend("x-default" = "contacts hold whatever the force"))]
    pub friction: Option<Friction>,
    /// blocks, base first; or `column`
    #[schemars(extend("x-default" = "one of `block`, `column`"))]
    pub block: Option<Vec<Block>>,
    /// a column that is cut into blocks of equal height; or `block`
    #[schemars(extend("x-default" = "one of `block`, `column`"))]
    pub column: Option<Column>,
    /// slenderness and size to which the column is scaled
    #[schemars(extend("x-default" = "as given"))]
    pub size: Option<Size>,
    /// what impacts do beyond the plastic law
    #[schemars(extend("x-default" = "plastic"))]
    pub restitution: Option<Restitution>,
    /// ground motion
    #[schemars(extend("x-default" = "none"))]
    pub excitation: Option<Excitation>,
    /// state at t = 0
    #[schemars(extend("x-default" = "at rest"))]
    pub initial: Option<Initial>,
    /// end of the run, method, tolerances
    pub solver: Option<Solver>,
    /// rows of response.csv
    pub output: Option<Output>,
}

/// A block, base first.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Block {
    /// free text, for reports
    #[schemars(extend("x-default" = "empty"))]
    pub name: Option<String>,
    /// keys that a column has as well
    #[schemars(flatten)]
    pub sizes: Sizes,
}

/// Sizes and material of a block, or of a column.
#[derive(JsonSchema)]
pub struct Sizes {
    /// the solid: a prism has the same side view at every depth, a drum is a cylinder or frustum
    #[schemars(extend("enum" = ["prism", "drum"], "x-default" = "prism; with a diameter drum"))]
    pub shape: Option<String>,
    /// half of the width
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "one of `half_width`, `width`, `diameter`"))]
    pub half_width: Option<f64>,
    /// the width
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "one of `half_width`, `width`, `diameter`"))]
    pub width: Option<f64>,
    /// the width of a drum
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "one of `half_width`, `width`, `diameter`"))]
    pub diameter: Option<f64>,
    /// half of the width of the base of a tapered block; replaces `half_width` there
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "`half_width`"))]
    pub bottom_half_width: Option<f64>,
    /// the width of the base
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "`width`"))]
    pub bottom_width: Option<f64>,
    /// the width of a drum's base
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "`diameter`"))]
    pub bottom_diameter: Option<f64>,
    /// half of the width of the top; of a column, of the top of the highest block
    #[schemars(range(min = 0), extend("x-unit" = "m", "x-default" = "`half_width`"))]
    pub top_half_width: Option<f64>,
    /// the width of the top
    #[schemars(range(min = 0), extend("x-unit" = "m", "x-default" = "`width`"))]
    pub top_width: Option<f64>,
    /// the width of a drum's top
    #[schemars(range(min = 0), extend("x-unit" = "m", "x-default" = "`diameter`"))]
    pub top_diameter: Option<f64>,
    /// half of the height; of a column, of the whole column
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "one of `half_height`, `height`"))]
    pub half_height: Option<f64>,
    /// the height; of a column, of the whole column
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "one of `half_height`, `height`"))]
    pub height: Option<f64>,
    /// depth of a prism, with a density in kg/m³
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "none"))]
    pub depth: Option<f64>,
    /// in kg/m³ for a drum or with `depth`, otherwise in kg/m² of the side view; or `mass`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "kg/m³ or kg/m²", "x-default" = "1"))]
    pub density: Option<f64>,
    /// mass of the block, or of the whole column; or `density`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "kg", "x-default" = "from the density"))]
    pub mass: Option<f64>,
    /// height of the centroid above the base; in `[column]` with `blocks = 1` only
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "of the homogeneous body"))]
    pub centroid_height: Option<f64>,
    /// moment of inertia about the centroid; in `[column]` with `blocks = 1` only
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "kg m²", "x-default" = "of the homogeneous body"))]
    pub inertia: Option<f64>,
}

/// A column that is cut into blocks of equal height.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Column {
    /// number of blocks
    #[schemars(range(min = 1, max = 100))]
    pub blocks: u32,
    /// name of the block, of a column of one block
    #[schemars(extend("x-default" = "empty"))]
    pub name: Option<String>,
    /// keys that a block has as well
    #[schemars(flatten)]
    pub sizes: Sizes,
}

/// Sizes to which the column as one body is scaled: first its widths alone, to reach `alpha`; then all its lengths, to reach `p`, `rocking_period` or `R`.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Size {
    /// slenderness: the angle at which the column is balanced over its edge
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = std::f64::consts::FRAC_PI_2, "x-unit" = "rad", "x-default" = "as the column is given"))]
    pub alpha: Option<f64>,
    /// frequency parameter; or `rocking_period`, or `R`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "rad/s", "x-default" = "`R` stays"))]
    pub p: Option<f64>,
    /// 2π/p, the abscissa of rocking spectra; or `p`, or `R`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "`R` stays"))]
    pub rocking_period: Option<f64>,
    /// distance of the centroid from a corner of the base; or `p`, or `rocking_period`
    #[schemars(rename = "R", extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "`R` stays"))]
    pub radius: Option<f64>,
}

/// One coefficient, or a table of static and kinetic ones.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum Friction {
    Number(#[schemars(range(min = 0, max = 1e8))] f64),
    Table(Coefficients),
}

/// Coefficients of friction.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Coefficients {
    /// of contacts that stick, from 0 to 1e8; one number, or one per interface, base first
    #[schemars(rename = "static")]
    pub fixed: NumberOrList,
    /// of contacts that slide, and of impacts; no larger than `static`
    #[schemars(extend("x-default" = "`static`"))]
    pub kinetic: Option<NumberOrList>,
}

/// A number, or a list of numbers.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum NumberOrList {
    Number(f64),
    List(Vec<f64>),
}

/// What impacts do beyond the plastic law: one of these keys.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Restitution {
    /// angular momentum about the new pivots is conserved
    #[schemars(extend("enum" = ["plastic"], "x-default" = "plastic"))]
    pub law: Option<String>,
    /// ratio of the rates after and before an impact of the column as one body
    #[schemars(range(min = 0, max = 1), extend("x-default" = "none"))]
    pub eta: Option<f64>,
    /// factor of the plastic relative rate at each interface, 0 or above, base first
    #[schemars(extend("x-default" = "none"))]
    pub factors: Option<Vec<f64>>,
}

/// Ground motion.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Excitation {
    /// positive to the right
    #[schemars(extend("x-default" = "none"))]
    pub horizontal: Option<Component>,
    /// positive upwards
    #[schemars(extend("x-default" = "none"))]
    pub vertical: Option<Component>,
    /// components of one record, in place of both
    #[schemars(extend("x-default" = "none"))]
    pub station: Option<Station>,
}

/// State at t = 0. Lists have one number per block or interface, base first.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Initial {
    /// absolute angles, below `overturn_angle`
    #[schemars(extend("x-unit" = "rad", "x-default" = "0"))]
    pub theta: Option<Vec<f64>>,
    /// rates
    #[schemars(extend("x-unit" = "rad/s", "x-default" = "0"))]
    pub omega: Option<Vec<f64>>,
    /// slides of the interfaces: displaced blocks
    #[schemars(extend("x-unit" = "m", "x-default" = "0"))]
    pub slide: Option<Vec<f64>>,
    /// places of the centroids to the right, in the ground's frame; with friction
    #[schemars(extend("x-unit" = "m", "x-default" = "as the blocks stand, if none of the four is given"))]
    pub x: Option<Vec<f64>>,
    /// heights of the centroids; with `x`
    #[schemars(extend("x-unit" = "m", "x-default" = "as the blocks stand, if none of the four is given"))]
    pub y: Option<Vec<f64>>,
    /// velocities of the centroids to the right; with `x`
    #[schemars(extend("x-unit" = "m/s", "x-default" = "as the blocks stand, if none of the four is given"))]
    pub vx: Option<Vec<f64>>,
    /// velocities of the centroids upwards; with `x`
    #[schemars(extend("x-unit" = "m/s", "x-default" = "as the blocks stand, if none of the four is given"))]
    pub vy: Option<Vec<f64>>,
}

/// End of the run, method, tolerances.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Solver {
    /// end of the run
    #[schemars(range(min = 1e-9), extend("x-unit" = "s", "x-default" = "20/p, at least 10 s, after the ground motion, rounded up to a second"))]
    pub t_end: Option<f64>,
    /// method of the smooth phases
    #[schemars(extend("x-default" = "auto"))]
    pub method: Option<Method>,
    /// relative tolerance of a step
    #[schemars(range(min = 1e-14, max = 0.01), extend("x-default" = "1e-9"))]
    pub rtol: Option<f64>,
    /// absolute tolerance of a step
    #[schemars(range(max = 0.01), extend("exclusiveMinimum" = 0, "x-unit" = "rad, rad/s", "x-default" = "1e-12"))]
    pub atol: Option<f64>,
    /// length of the steps of `rk4`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "1e-3"))]
    pub step: Option<f64>,
    /// a hop lower than this closes
    #[schemars(range(min = 1e-14, max = 0.01), extend("x-unit" = "rad", "x-default" = "1e-9"))]
    pub stick_angle: Option<f64>,
    /// the column has overturned when some angle reaches this
    #[schemars(extend("maximum" = std::f64::consts::PI, "exclusiveMinimum" = 0, "x-unit" = "rad", "x-default" = "pi/2"))]
    pub overturn_angle: Option<f64>,
}

/// A method of integration.
#[derive(JsonSchema)]
#[schemars(rename_all = "kebab-case")]
pub enum Method {
    Auto,
    Taylor,
    Dop853,
    #[schemars(rename = "dormand-prince54")]
    DormandPrince54,
    Dopri5,
    Rk45,
    KuttaMerson,
    Rk4,
}

/// Rows of response.csv.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Output {
    /// interval between rows
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "0.01"))]
    pub dt: Option<f64>,
    /// times of the rows in ascending order, from 0 to `t_end`, instead of `dt`
    #[schemars(length(min = 1), extend("x-unit" = "s", "x-default" = "multiples of dt"))]
    pub times: Option<Vec<f64>>,
    /// columns that are added: `relative` rotations of the interfaces, displacement of the `top`
    #[schemars(extend("x-unit" = "rad, m", "x-default" = "none"))]
    pub columns: Option<Vec<OutputColumn>>,
}

/// Columns of response.csv.
#[derive(JsonSchema)]
#[schemars(rename_all = "kebab-case")]
pub enum OutputColumn {
    Relative,
    Top,
}
