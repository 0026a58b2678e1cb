//! Expressions as text, for people and for golden tests.

use super::arena::{Arena, Expr, Node, Unit};
use super::rational::Rational;

impl Arena {
    /// The expression as one line of text: `cos(theta_1)*half_height_1 - 2*mass_1`.
    pub fn text(&self, expr: Expr) -> String {
        self.text_with(expr, &|_| None)
    }

    /// The expression as [`Arena::text`], sub-expressions that have a name printed as that name.
    pub fn text_with(&self, expr: Expr, name: &dyn Fn(Expr) -> Option<String>) -> String {
        if let Some(name) = name(expr) {
            return name;
        }
        match self.node(expr) {
            Node::Number(value) => rational_text(*value),
            Node::Symbol(rank) => self.symbol_data(*rank).name.clone(),
            Node::Sin(angle) => format!("sin({})", self.text_with(*angle, name)),
            Node::Cos(angle) => format!("cos({})", self.text_with(*angle, name)),
            Node::Product(factors) => {
                let power = |(factor, exponent): &(Expr, i32)| {
                    let base = self.text_with(*factor, name);
                    let is_sum = matches!(self.node(*factor), Node::Sum(_)) && name(*factor).is_none();
                    let base = if is_sum { format!("({base})") } else { base };
                    if exponent.abs() == 1 { base } else { format!("{base}^{}", exponent.abs()) }
                };
                let above: Vec<String> = factors.iter().filter(|(_, exponent)| *exponent > 0).map(power).collect();
                let below = factors.iter().filter(|(_, exponent)| *exponent < 0);
                let numerator = if above.is_empty() { "1".into() } else { above.join("*") };
                below.fold(numerator, |text, factor| format!("{text}/{}", power(factor)))
            }
            Node::Sum(terms) => {
                let mut text = String::new();
                for (position, (coefficient, term)) in terms.iter().enumerate() {
                    let sign = match (position, coefficient.is_negative()) {
                        (0, true) => "-",
                        (0, false) => "",
                        (_, true) => " - ",
                        (_, false) => " + ",
                    };
                    let size = if coefficient.is_negative() { -*coefficient } else { *coefficient };
                    let body = match (size == Rational::ONE, self.node(*term)) {
                        (_, Node::Number(_)) => rational_text(size),
                        (true, _) => self.text_with(*term, name),
                        (false, _) => format!("{}*{}", rational_text(size), self.text_with(*term, name)),
                    };
                    text.push_str(sign);
                    text.push_str(&body);
                }
                text
            }
        }
    }
}

fn rational_text(value: Rational) -> String {
    match value.denominator {
        1 => value.numerator.to_string(),
        denominator => format!("{}/{denominator}", value.numerator),
    }
}

/// `kg m^2`, or `-` for a pure number.
impl std::fmt::Display for Unit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let parts: Vec<String> = [("kg", self.1), ("m", self.0), ("s", self.2)]
            .iter()
            .filter(|(_, exponent)| *exponent != 0)
            .map(|(name, exponent)| if *exponent == 1 { (*name).to_string() } else { format!("{name}^{exponent}") })
            .collect();
        if parts.is_empty() { write!(f, "-") } else { write!(f, "{}", parts.join(" ")) }
    }
}
