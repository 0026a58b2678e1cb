//! Hairer, Nørsett & Wanner's DOP853: order 8 with an error estimate of orders 5 and 3, dense output of order 7. The default:
//! cheapest of the pairs here at tolerances below about 1e-6.
//!
//! Coefficients: Hairer's `dop853.f`, as in Solving Ordinary Differential Equations I, section II.5 and appendix.

use super::{Interpolant, Pair, System, Term, Tolerance, combine, weighted};
use crate::dynamics::StateVector;

const A2: [Term; 1] = [(0, 0.05260015195876773)];
const A3: [Term; 2] = [(0, 0.0197250569845379), (1, 0.0591751709536137)];
const A4: [Term; 2] = [(0, 0.02958758547680685), (2, 0.08876275643042054)];
const A5: [Term; 3] = [(0, 0.2413651341592667), (2, -0.8845494793282861), (3, 0.924834003261792)];
const A6: [Term; 3] = [(0, 0.037037037037037035), (3, 0.17082860872947386), (4, 0.12546768756682242)];
const A7: [Term; 4] = [(0, 0.037109375), (3, 0.17025221101954405), (4, 0.06021653898045596), (5, -0.017578125)];
const A8: [Term; 5] = [
    (0, 0.03709200011850479),
    (3, 0.17038392571223998),
    (4, 0.10726203044637328),
    (5, -0.015319437748624402),
    (6, 0.008273789163814023),
];
const A9: [Term; 6] = [
    (0, 0.6241109587160757),
    (3, -3.3608926294469414),
    (4, -0.868219346841726),
    (5, 27.59209969944671),
    (6, 20.154067550477894),
    (7, -43.48988418106996),
];
const A10: [Term; 7] = [
    (0, 0.47766253643826434),
    (3, -2.4881146199716677),
    (4, -0.590290826836843),
    (5, 21.230051448181193),
    (6, 15.279233632882423),
    (7, -33.28821096898486),
    (8, -0.020331201708508627),
];
const A11: [Term; 8] = [
    (0, -0.9371424300859873),
    (3, 5.186372428844064),
    (4, 1.0914373489967295),
    (5, -8.149787010746927),
    (6, -18.52006565999696),
    (7, 22.739487099350505),
    (8, 2.4936055526796523),
    (9, -3.0467644718982196),
];
const A12: [Term; 9] = [
    (0, 2.273310147516538),
    (3, -10.53449546673725),
    (4, -2.0008720582248625),
    (5, -17.9589318631188),
    (6, 27.94888452941996),
    (7, -2.8589982771350235),
    (8, -8.87285693353063),
    (9, 12.360567175794303),
    (10, 0.6433927460157636),
];
const B: [Term; 8] = [
    (0, 0.054293734116568765),
    (5, 4.450312892752409),
    (6, 1.8915178993145003),
    (7, -5.801203960010585),
    (8, 0.3111643669578199),
    (9, -0.1521609496625161),
    (10, 0.20136540080403034),
    (11, 0.04471061572777259),
];
const A14: [Term; 8] = [
    (0, 0.056167502283047954),
    (6, 0.25350021021662483),
    (7, -0.2462390374708025),
    (8, -0.12419142326381637),
    (9, 0.15329179827876568),
    (10, 0.00820105229563469),
    (11, 0.007567897660545699),
    (12, -0.008298),
];
const A15: [Term; 8] = [
    (0, 0.03183464816350214),
    (5, 0.028300909672366776),
    (6, 0.053541988307438566),
    (7, -0.05492374857139099),
    (10, -0.00010834732869724932),
    (11, 0.0003825710908356584),
    (12, -0.00034046500868740456),
    (13, 0.1413124436746325),
];
const A16: [Term; 8] = [
    (0, -0.42889630158379194),
    (5, -4.697621415361164),
    (6, 7.683421196062599),
    (7, 4.06898981839711),
    (8, 0.3567271874552811),
    (12, -0.0013990241651590145),
    (13, 2.9475147891527724),
    (14, -9.15095847217987),
];
/// Nodes of the stages, `k[0]` at 0; `k[12]` is the slope at the step's end.
const C: [f64; 16] = [
    0.0,
    0.05260015195876773,
    0.0789002279381516,
    0.1183503419072274,
    0.2816496580927726,
    0.3333333333333333,
    0.25,
    0.3076923076923077,
    0.6512820512820513,
    0.6,
    0.8571428571428571,
    1.0,
    1.0,
    0.1,
    0.2,
    0.7777777777777778,
];
/// Embedded fifth-order error.
const E5: [Term; 8] = [
    (0, 0.01312004499419488),
    (5, -1.2251564463762044),
    (6, -0.4957589496572502),
    (7, 1.6643771824549864),
    (8, -0.35032884874997366),
    (9, 0.3341791187130175),
    (10, 0.08192320648511571),
    (11, -0.022355307863886294),
];
/// Embedded third-order error.
const E3: [Term; 8] = [
    (0, -0.18980075407240762),
    (5, 4.450312892752409),
    (6, 1.8915178993145003),
    (7, -5.801203960010585),
    (8, -0.4226823213237919),
    (9, -0.1521609496625161),
    (10, 0.20136540080403034),
    (11, 0.02265179219836082),
];
const D4: [Term; 12] = [
    (0, -8.428938276109013),
    (5, 0.5667149535193777),
    (6, -3.0689499459498917),
    (7, 2.38466765651207),
    (8, 2.117034582445028),
    (9, -0.871391583777973),
    (10, 2.2404374302607883),
    (11, 0.6315787787694688),
    (12, -0.08899033645133331),
    (13, 18.148505520854727),
    (14, -9.194632392478356),
    (15, -4.436036387594894),
];
const D5: [Term; 12] = [
    (0, 10.427508642579134),
    (5, 242.28349177525817),
    (6, 165.20045171727028),
    (7, -374.5467547226902),
    (8, -22.113666853125306),
    (9, 7.733432668472264),
    (10, -30.674084731089398),
    (11, -9.332130526430229),
    (12, 15.697238121770845),
    (13, -31.139403219565178),
    (14, -9.35292435884448),
    (15, 35.81684148639408),
];
const D6: [Term; 12] = [
    (0, 19.985053242002433),
    (5, -387.0373087493518),
    (6, -189.17813819516758),
    (7, 527.8081592054236),
    (8, -11.57390253995963),
    (9, 6.8812326946963),
    (10, -1.0006050966910838),
    (11, 0.7777137798053443),
    (12, -2.778205752353508),
    (13, -60.19669523126412),
    (14, 84.32040550667716),
    (15, 11.99229113618279),
];
const D7: [Term; 12] = [
    (0, -25.69393346270375),
    (5, -154.18974869023643),
    (6, -231.5293791760455),
    (7, 357.6391179106141),
    (8, 93.40532418362432),
    (9, -37.45832313645163),
    (10, 104.0996495089623),
    (11, 29.8402934266605),
    (12, -43.53345659001114),
    (13, 96.32455395918828),
    (14, -39.17726167561544),
    (15, -149.72683625798564),
];

/// The pair and its stages.
#[derive(Clone, Debug)]
pub struct Dop853<V> {
    t: f64,
    h: f64,
    x: V,
    end: V,
    inner: V,
    k: [V; 16],
}

impl<V: StateVector> Dop853<V> {
    #[inline(always)]
    fn stage<S: System<State = V>, const M: usize>(&mut self, system: &mut S, index: usize, a: &[Term; M]) {
        combine(&self.x, self.h, &self.k, a, &mut self.inner);
        system.slope(self.t + C[index] * self.h, &self.inner, &mut self.k[index]);
    }
}

impl<V: StateVector> Pair<V> for Dop853<V> {
    const ORDER: usize = 8;
    const ERROR_ORDER: usize = 8;
    const STAGES: usize = 11;

    fn new(zero: &V) -> Self {
        Dop853 {
            t: 0.0,
            h: 0.0,
            x: zero.clone(),
            end: zero.clone(),
            inner: zero.clone(),
            k: std::array::from_fn(|_| zero.clone()),
        }
    }

    fn attempt<S: System<State = V>>(
        &mut self,
        system: &mut S,
        t: f64,
        x: &V,
        slope: &V,
        h: f64,
        tolerance: Tolerance,
    ) -> f64 {
        (self.t, self.h) = (t, h);
        self.x.clone_from(x);
        self.k[0].clone_from(slope);
        self.stage(system, 1, &A2);
        self.stage(system, 2, &A3);
        self.stage(system, 3, &A4);
        self.stage(system, 4, &A5);
        self.stage(system, 5, &A6);
        self.stage(system, 6, &A7);
        self.stage(system, 7, &A8);
        self.stage(system, 8, &A9);
        self.stage(system, 9, &A10);
        self.stage(system, 10, &A11);
        self.stage(system, 11, &A12);
        combine(&self.x, h, &self.k, &B, &mut self.end);
        let (mut fifth, mut third) = (0.0, 0.0);
        let count = self.x.as_slice().len();
        for i in 0..count {
            let scale = tolerance.scale(self.x.as_slice()[i], self.end.as_slice()[i]);
            let (e5, e3) = (weighted(h, &self.k, &E5, i) / scale, weighted(h, &self.k, &E3, i) / scale);
            fifth += e5 * e5;
            third += e3 * e3;
        }
        let denominator = fifth + 0.01 * third;
        if denominator == 0.0 { 0.0 } else { fifth / (denominator * count as f64).sqrt() }
    }

    fn end(&self) -> &V {
        &self.end
    }

    fn accept<S: System<State = V>>(&mut self, system: &mut S) {
        system.slope(self.t + self.h, &self.end, &mut self.k[12]);
    }

    fn end_slope(&self) -> &V {
        &self.k[12]
    }

    fn interpolate<S: System<State = V>>(&mut self, system: &mut S, interpolant: &mut Interpolant<V>) {
        self.stage(system, 13, &A14);
        self.stage(system, 14, &A15);
        self.stage(system, 15, &A16);
        interpolant.hermite(self.t, self.h, &self.x, &self.end, &self.k[0], &self.k[12]);
        for i in 0..self.x.as_slice().len() {
            interpolant.nested[3].as_mut_slice()[i] = weighted(self.h, &self.k, &D4, i);
            interpolant.nested[4].as_mut_slice()[i] = weighted(self.h, &self.k, &D5, i);
            interpolant.nested[5].as_mut_slice()[i] = weighted(self.h, &self.k, &D6, i);
            interpolant.nested[6].as_mut_slice()[i] = weighted(self.h, &self.k, &D7, i);
        }
        interpolant.terms = 7;
    }
}
