//! Keys of a component of the ground motion.

#![allow(dead_code, reason = "types of which only the schema is made")]

use super::record::{Reading, Sizes};
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
    #[schemars(range(min = 1, max = 1_000_000), extend("x-default" = "required by `type-c`"))]
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
    /// keys of the reader of files
    #[schemars(flatten)]
    pub reading: Reading,
    /// factor of the samples of a record; or one of the sizes
    #[schemars(extend("x-default" = "1"))]
    pub scale: Option<f64>,
    /// sizes to which a record is scaled
    #[schemars(flatten)]
    pub sizes: Sizes,
    /// seed of `synthetic`
    #[schemars(extend("x-default" = "0"))]
    pub seed: Option<u64>,
    /// damping ratio of the filters of `synthetic`
    #[schemars(extend("exclusiveMinimum" = 0, "x-default" = "0.6"))]
    pub damping: Option<f64>,
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
