//! Expressions as text, for people and for golden tests.

use super::{Arena, Expr, Node, Rational, Unit};

impl Arena {
    /// The expression as one line of text: `cos(theta_1)*half_height_1 - 2*mass_1`.
    pub fn text(&self, expr: Expr) -> String {
        match self.node(expr) {
            Node::Number(value) => rational_text(*value),
            Node::Symbol(rank) => self.symbol_data(*rank).name.clone(),
            Node::Sin(angle) => format!("sin({})", self.text(*angle)),
            Node::Cos(angle) => format!("cos({})", self.text(*angle)),
            Node::Product(factors) => {
                let factors: Vec<String> = factors
                    .iter()
                    .map(|(factor, exponent)| {
                        let base = match self.node(*factor) {
                            Node::Sum(_) => format!("({})", self.text(*factor)),
                            _ => self.text(*factor),
                        };
                        if *exponent == 1 { base } else { format!("{base}^{exponent}") }
                    })
                    .collect();
                factors.join("*")
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
                        (true, _) => self.text(*term),
                        (false, _) => format!("{}*{}", rational_text(size), self.text(*term)),
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
