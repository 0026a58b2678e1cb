//! Measures of synthetic records against two other programs.
//!
//! The numbers were made once with Python 3.11, numpy 2.4.6, eqsig 1.2.17 and pyrotd 0.6.1 on the records below, as `Record::to_csv` writes them:
//!
//! ```python
//! t, a = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True); dt = t[1] - t[0]
//! sig = eqsig.AccSignal(a, dt); sig.generate_displacement_and_velocity_series()      # sig.pga, sig.pgv, sig.pgd
//! eqsig.im.calc_arias_intensity(sig)[-1]; eqsig.im.calc_cav(sig)[-1]
//! s, e = eqsig.im.calc_sig_dur_vals(a, dt, se=True); e - s                            # and with start=0.05, end=0.75
//! eqsig.sdof.pseudo_response_spectra(a, dt, periods, 0.05)[2]
//! pyrotd.calc_spec_accels(dt, np.concatenate([a, np.zeros(len(a))]), 1 / periods, 0.05).spec_accel
//! n = 4096; c = np.abs(np.fft.rfft(a, n)) ** 2; f = np.fft.rfftfreq(n, dt); k = (f >= .25) & (f <= 20)
//! (c[k] / f[k]).sum() / c[k].sum()                                                   # mean period
//! ```

use rocking_ground::{Record, Synthetic};

/// Periods of the spectra `[s]`.
const PERIODS: [f64; 4] = [0.1, 0.3, 1.0, 2.5];

/// What the other programs find, in SI.
struct Other {
    seed: u64,
    /// Of the ground filter `[Hz]`.
    frequency: f64,
    pgv: f64,
    pgd: f64,
    arias: f64,
    cav: f64,
    duration: f64,
    duration_75: f64,
    mean_period: f64,
    eqsig: [f64; 4],
    pyrotd: [f64; 4],
}

const OTHERS: [Other; 3] = [
    Other {
        seed: 11,
        frequency: 2.5,
        pgv: 0.3672468822841332,
        pgd: 0.25942578286824425,
        arias: 0.7635834152531326,
        cav: 5.725770372138086,
        duration: 7.89,
        duration_75: 6.255,
        mean_period: 0.7058737776022802,
        eqsig: [4.965896679910348, 4.982732194163708, 3.517258763454949, 1.650418768649771],
        pyrotd: [4.984293847882361, 4.98486415788471, 3.5175055851934225, 1.664429938807042],
    },
    Other {
        seed: 12,
        frequency: 1.0,
        pgv: 0.5872101025524041,
        pgd: 1.2334286639438,
        arias: 1.4822847421844132,
        cav: 8.446882867020356,
        duration: 8.275,
        duration_75: 4.98,
        mean_period: 0.9399478283647782,
        eqsig: [5.24135979339536, 5.364605331662255, 6.519484608299313, 1.629343125718542],
        pyrotd: [5.273024836225435, 5.369253344150973, 6.520087889505887, 1.6391063097801595],
    },
    Other {
        seed: 13,
        frequency: 4.0,
        pgv: 0.22150956606841476,
        pgd: 0.09615785894981602,
        arias: 1.1917724529060434,
        cav: 7.3758242548290225,
        duration: 8.03,
        duration_75: 5.36,
        mean_period: 0.336405588981058,
        eqsig: [5.976502306414573, 6.950076582501573, 2.371697043547729, 0.6732390719205212],
        pyrotd: [6.014367646090422, 6.957146299621973, 2.372026359055807, 0.6767791873172857],
    },
];

impl Other {
    fn record(&self) -> Record {
        let synthetic = Synthetic { seed: self.seed, frequency: self.frequency, dt: DT, ..Synthetic::default() };
        synthetic.record().expect("valid")
    }
}

const DT: f64 = 0.005;

fn close(found: f64, other: f64, tolerance: f64) -> bool {
    (found / other - 1.0).abs() < tolerance
}

/// eqsig integrates by trapezoids. Of the same samples the trapezoids of `f(a)` are computed here, so that the same quantity is seen to be meant;
/// the exact integrals of the line between samples are below them, the more so the rougher the record.
#[test]
fn integrals_agree_with_eqsig() {
    for other in OTHERS {
        let record = other.record();
        let measures = record.measures(9.81);
        let trapezoids = |f: fn(f64) -> f64| -> f64 {
            record.accel().windows(2).map(|pair| 0.5 * DT * (f(pair[0]) + f(pair[1]))).sum()
        };
        assert!(close(std::f64::consts::PI / (2.0 * 9.81) * trapezoids(|a| a * a), other.arias, 1e-9));
        assert!(close(trapezoids(f64::abs), other.cav, 1e-9));
        assert!(measures.arias < other.arias && close(measures.arias, other.arias, 0.02), "{}", measures.arias);
        assert!(measures.cav < other.cav && close(measures.cav, other.cav, 0.01), "{}", measures.cav);
        // Largest between samples, not at one of them.
        assert!(measures.pgv >= other.pgv && close(measures.pgv, other.pgv, 2e-3), "{}", measures.pgv);
        assert!(close(measures.pgd, other.pgd, 2e-4), "{}", measures.pgd);
    }
}

/// eqsig takes the samples at which the shares are passed: each end is off by less than an interval, and the trapezoids shift the shares.
#[test]
fn durations_agree_with_eqsig() {
    for other in OTHERS {
        let measures = other.record().measures(9.81);
        assert!((measures.significant_duration - other.duration).abs() < 2.0 * DT, "{measures:?}");
        // The energy grows slowly at 75 % of record 13: a share of 0.1 % is five intervals there.
        assert!((measures.significant_duration_75 - other.duration_75).abs() < 6.0 * DT, "{measures:?}");
    }
}

#[test]
fn the_mean_period_is_that_of_numpys_transform() {
    for other in OTHERS {
        let found = other.record().measures(9.81).mean_period;
        assert!(found.is_some_and(|found| close(found, other.mean_period, 1e-12)), "{found:?}");
    }
}

/// eqsig uses the same recurrence and takes the largest sample: smaller by at most `(ω dt / 2)² / 2`. pyrotd filters in the frequency domain and
/// interpolates by trigonometric polynomials rather than lines: the difference was 1 % at most.
#[test]
fn spectra_agree_with_eqsig_and_pyrotd() {
    for other in OTHERS {
        let record = other.record();
        for (place, period) in PERIODS.into_iter().enumerate() {
            let found = record.spectral_acceleration(period, 0.05);
            let missed = 0.5 * (std::f64::consts::PI * DT / period).powi(2);
            let ratio = other.eqsig[place] / found;
            // Rounding, and eqsig's start: a small acceleration at the first sample.
            assert!(ratio < 1.0 + 1e-9 && ratio > 1.0 - missed - 1e-4, "{} {period}: {ratio}", other.seed);
            assert!(close(found, other.pyrotd[place], 0.01), "{} {period}: {found}", other.seed);
        }
    }
}
