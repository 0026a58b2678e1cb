//! Trust in a sentence.

use super::Trust;
use super::further::Further;
use super::verdict::Verdict;

impl Trust {
    /// Words before the outcome of a run whose verdict is not determined; otherwise empty.
    pub fn lead(&self) -> &'static str {
        match self.is_open() {
            true if self.likely => "not determined, but likely; this run ",
            true => "not determined; this run ",
            false => "",
        }
    }

    /// Trust in a line: if the verdict is determined, how many companions agree; if not, how far angles are known and the verdicts of the companions.
    pub fn sentence(&self) -> String {
        let count = self.companions.len() + self.further.map_or(0, |further| further.runs);
        let grown = match self.grows_on {
            true => format!("small changes grow more than {} times", times(self.amplification)),
            false if self.amplification < 1.0 => "small changes do not grow".to_string(),
            false => format!("small changes grow {} times", times(self.amplification)),
        };
        if self.determined {
            let slides = self.slide_horizon.filter(|slides| *slides < self.input_horizon);
            let slides_known = slides.map(|slides| format!("slides are known up to t = {slides:.4} s only"));
            let until = match self.reaches_the_end() {
                true if slides.is_some() => "agree to the end but for slides".to_string(),
                true => "agree to the end".to_string(),
                false => format!(
                    "have this verdict and move alike up to t = {:.4} s{}",
                    self.input_horizon,
                    self.spacing(self.input_horizon)
                ),
            };
            let mut text = format!("{count} companions {until}, {grown}");
            if let Some(known) = slides_known {
                text.push_str("; ");
                text.push_str(&known);
            }
            if let Some(fold) = &self.fold {
                text.push_str("; ");
                text.push_str(&fold.sentence(self.verdict));
            }
            return text;
        }
        let verdicts = self.verdicts();
        let verdicts_in_words = match (&verdicts[..], self.further) {
            (_, Some(Further { others: 0, .. })) => format!("all {count} companions {} as well", plural(self.verdict)),
            (_, Some(Further { others: 1, .. })) => format!("of {count} companions 1 has another verdict"),
            (_, Some(Further { others, .. })) => format!("of {count} companions {others} have another verdict"),
            ([(Some(verdict), _)], None) if *verdict == self.verdict => {
                format!("all {count} companions {} as well", plural(*verdict))
            }
            (counts, None) => {
                let counts: Vec<String> = counts.iter().map(|one| counted(*one)).collect();
                format!("of {count} companions {}", counts.join(", "))
            }
        };
        let known = match self.horizon >= self.ends_at
            && verdicts.iter().any(|(verdict, _)| *verdict == Some(Verdict::MayOverturn))
        {
            true => "angles are known to the end of the run, but the column may be falling then: give a later t_end"
                .to_string(),
            false => {
                let (known, spacing) = (self.known_until(), self.spacing(self.known_until()));
                let earlier = self.slide_horizon.filter(|slides| *slides < known);
                let slides = earlier.map_or(String::new(), |t| format!("; slides are known up to t = {t:.4} s only"));
                match self.is_open_by_inputs() {
                    true => format!(
                        "a change of the inputs by a millionth alters the motion from t = {known:.4} s on{spacing}{slides}"
                    ),
                    false => format!("angles are known up to t = {known:.4} s only{spacing}{slides}"),
                }
            }
        };
        format!("{known}; {grown}; {verdicts_in_words}")
    }

    /// The interval of the rows in words, where it is more than a small part of a horizon.
    fn spacing(&self, horizon: f64) -> String {
        match self.compared_every > COARSE_SHARE * horizon {
            true => format!(" (compared every {:.2} s)", self.compared_every),
            false => String::new(),
        }
    }
}

/// Share of a horizon above which the interval between rows is named beside it.
const COARSE_SHARE: f64 = 0.05;

/// A verdict and the number of companions that have it, in words.
fn counted((verdict, count): (Option<Verdict>, usize)) -> String {
    match (verdict, count) {
        (None, _) => format!("{count} failed"),
        (Some(verdict), 1) => format!("1 {verdict}"),
        (Some(verdict), _) => format!("{count} {}", plural(verdict)),
    }
}

/// The verb of a verdict in the plural: `stand`, `overturn`.
fn plural(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Stands => "stand",
        Verdict::MayOverturn => "may overturn",
        Verdict::Overturns => "overturn",
        Verdict::Collapses => "collapse",
        Verdict::Undetermined => "end undetermined",
    }
}

/// A factor in words: one decimal below 100, none below 1e5, above it the leading digit and the power of ten.
fn times(factor: f64) -> String {
    match factor {
        factor if factor < 100.0 => format!("{factor:.1}"),
        factor if factor < 1e5 => format!("{:.0}", factor),
        factor => format!("{factor:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use crate::trust::{Trust, follow};
    use crate::{Column, Scene};

    /// Runs of many minutes have rows far apart.
    #[test]
    fn coarse_rows_are_named_beside_the_horizon() {
        let scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes"));
        let (_, trust) = follow(&scene).expect("runs");
        let sentence = |compared_every: f64| {
            let ends_at = 60.0;
            let (horizon, certain_at) = (2.0, 5.0);
            Trust { determined: false, horizon, certain_at, ends_at, compared_every, ..trust.clone() }.sentence()
        };
        assert!(sentence(1.0).contains("t = 2.0000 s only (compared every 1.00 s)"), "{}", sentence(1.0));
        assert!(!sentence(0.05).contains("compared every"), "{}", sentence(0.05));
    }

    /// Slides may part before angles do.
    #[test]
    fn slides_have_a_horizon_of_their_own() {
        let scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes"));
        let (_, trust) = follow(&scene).expect("runs");
        let sentence = |certain_at: f64, slide_horizon: Option<f64>| {
            let (horizon, input_horizon, ends_at) = (6.0, 5.0, 60.0);
            let open = Trust {
                determined: false,
                horizon,
                input_horizon,
                certain_at,
                ends_at,
                slide_horizon,
                ..trust.clone()
            };
            open.sentence()
        };
        assert!(
            sentence(9.0, Some(2.0))
                .starts_with("angles are known up to t = 6.0000 s only; slides are known up to t = 2.0000 s only;")
        );
        assert!(
            sentence(4.0, Some(2.0)).contains("motion from t = 5.0000 s on; slides are known up to t = 2.0000 s only;")
        );
        assert!([None, Some(6.0)].iter().all(|slides| !sentence(9.0, *slides).contains("slides")));
    }
}
