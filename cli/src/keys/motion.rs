//! Keys of a component of the ground motion.

#![allow(dead_code, reason = "types of which only the schema is made")]

use schemars::JsonSchema;

/// A component of the ground motion; its kind decides which keys it takes.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Component {
    /// the motion: a pulse, `harmonic`, `sum`, `synthetic` or `record`
    pub kind: Kind,
    /// time at which the motion begins, of a record that of its first sample
    #[schemars(extend("x-unit" = "s", "x-default" = "0"))]
    pub start: Option<f64>,
    /// amplitude of the acceleration; of pulses and `harmonic`
    #[schemars(extend("x-unit" = "m/s²", "x-default" = "one of the amplitudes"))]
    pub amplitude: Option<f64>,
    /// the same in g
    #[schemars(extend("x-unit" = "g", "x-default" = "one of the amplitudes"))]
    pub amplitude_g: Option<f64>,
    /// the same over the acceleration that opens the base of the column
    #[schemars(extend("x-unit" = "g tan α", "x-default" = "one of the amplitudes"))]
    pub amplitude_uplift: Option<f64>,
    /// amplitude of the velocity; of `mavroeidis-papageorgiou` and `gabor`, in place of an amplitude
    #[schemars(extend("x-unit" = "m/s", "x-default" = "or an amplitude"))]
    pub velocity: Option<f64>,
    /// angular frequency; of pulses and `harmonic`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "rad/s", "x-default" = "one of the frequencies"))]
    pub omega: Option<f64>,
    /// frequency; of `synthetic`, of the ground: 1 for soft soil, 2.5 for firm ground, 4 for rock
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "Hz", "x-default" = "one of the frequencies; synthetic: 2.5"))]
    pub frequency: Option<f64>,
    /// period
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "one of the frequencies"))]
    pub period: Option<f64>,
    /// angular frequency over p of the column as one body
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "p", "x-default" = "one of the frequencies"))]
    pub omega_p: Option<f64>,
    /// phase; of `harmonic`, `mavroeidis-papageorgiou`, `gabor`
    #[schemars(extend("x-unit" = "rad", "x-default" = "0"))]
    pub phase: Option<f64>,
    /// width of the envelope; above 1 for `mavroeidis-papageorgiou`
    #[schemars(extend("exclusiveMinimum" = 0, "x-default" = "required by `mavroeidis-papageorgiou`, `gabor`"))]
    pub gamma: Option<f64>,
    /// length; of rectangular pulses, `harmonic`, `synthetic`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "rectangular: required; harmonic: for ever; synthetic: 20"))]
    pub duration: Option<f64>,
    /// n of type C_n
    #[schemars(range(min = 1), extend("x-default" = "required by `type-c`"))]
    pub cycles: Option<u32>,
    /// the motions that `sum` adds
    #[schemars(extend("x-default" = "required by `sum`"))]
    pub term: Option<Vec<Component>>,
    /// record file, relative to the scene; or `accel`
    #[schemars(extend("x-default" = "record: one of `file`, `accel`"))]
    pub file: Option<String>,
    /// samples of a record, with `dt`; or `file`
    #[schemars(extend("x-unit" = "`units`, m/s²", "x-default" = "record: one of `file`, `accel`"))]
    pub accel: Option<Vec<f64>>,
    /// sampling interval; of `record` and `synthetic`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "from the file; synthetic: 0.01"))]
    pub dt: Option<f64>,
    /// unit of the samples: `g`, `mg`, `m/s2`, `cm/s2`, `mm/s2`, `gal`, `in/s2`, `ft/s2`
    #[schemars(extend("x-default" = "from the file; accel: m/s2"))]
    pub units: Option<String>,
    /// accept a file with fewer samples than it declares
    #[schemars(extend("x-default" = "false"))]
    pub lenient: Option<bool>,
    /// channel of a file that has several
    #[schemars(range(min = 1), extend("x-default" = "the only one"))]
    pub channel: Option<u32>,
    /// column of a text table with the accelerations: its name, or its number from 1
    #[schemars(extend("x-default" = "found by itself"))]
    pub column: Option<NameOrNumber>,
    /// lines at the head of a text table that are not read
    #[schemars(extend("x-default" = "0"))]
    pub skip_rows: Option<u32>,
    /// factor of the samples of a record; or one of the sizes
    #[schemars(extend("x-default" = "1"))]
    pub scale: Option<f64>,
    /// peak acceleration to which a record is scaled; a size, of which `synthetic` needs one
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s²", "x-default" = "not scaled"))]
    pub pga: Option<f64>,
    /// the same in g
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g", "x-default" = "not scaled"))]
    pub pga_g: Option<f64>,
    /// the same over the acceleration that opens the base
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g tan α", "x-default" = "not scaled"))]
    pub pga_uplift: Option<f64>,
    /// peak velocity to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub pgv: Option<f64>,
    /// the same over g tan α / p
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g tan α / p", "x-default" = "not scaled"))]
    pub pgv_uplift: Option<f64>,
    /// peak displacement to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "not scaled"))]
    pub pgd: Option<f64>,
    /// Arias intensity to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub arias: Option<f64>,
    /// cumulative absolute velocity to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub cav: Option<f64>,
    /// pseudo-spectral acceleration at `sa_period` to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s²", "x-default" = "not scaled"))]
    pub sa: Option<f64>,
    /// the same in g
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g", "x-default" = "not scaled"))]
    pub sa_g: Option<f64>,
    /// period of the oscillator of `sa`, `sa_g`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "required with `sa`, `sa_g`"))]
    pub sa_period: Option<f64>,
    /// its damping ratio
    #[schemars(range(min = 0), extend("exclusiveMaximum" = 1, "x-default" = "0.05"))]
    pub sa_damping: Option<f64>,
    /// seed of `synthetic`
    #[schemars(extend("x-default" = "0"))]
    pub seed: Option<u64>,
    /// damping ratio of the filters of `synthetic`
    #[schemars(extend("exclusiveMinimum" = 0, "x-default" = "0.6"))]
    pub damping: Option<f64>,
}

/// A name, or a number.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum NameOrNumber {
    Name(String),
    Number(u32),
}

/// A kind of ground motion.
#[derive(JsonSchema)]
#[schemars(rename_all = "kebab-case")]
pub enum Kind {
    SinePulse,
    OneSine,
    TypeA,
    CosinePulse,
    OneCosine,
    TypeB,
    HalfSine,
    TypeC,
    Ricker,
    SymmetricRicker,
    AntisymmetricRicker,
    MavroeidisPapageorgiou,
    Gabor,
    Rectangular,
    DoubleRectangular,
    Harmonic,
    Sum,
    Synthetic,
    Record,
}
