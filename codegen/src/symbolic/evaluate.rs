//! Numeric value of an expression, for tests and for proving rewrites.

use super::arena::{Arena, Expr, Node};
use std::collections::HashMap;

/// Values of symbols.
pub type Environment = HashMap<Expr, f64>;

impl Arena {
    /// The value of `expr`, each shared node evaluated once.
    ///
    /// # Errors
    /// The name of the first symbol that `values` lacks.
    pub fn evaluate(&self, expr: Expr, values: &Environment) -> Result<f64, String> {
        self.value(expr, values, &mut HashMap::new())
    }

    fn value(&self, expr: Expr, values: &Environment, known: &mut HashMap<Expr, f64>) -> Result<f64, String> {
        if let Some(&value) = values.get(&expr).or_else(|| known.get(&expr)) {
            return Ok(value);
        }
        let value = match self.node(expr) {
            Node::Number(value) => value.to_f64(),
            Node::Symbol(rank) => return Err(self.symbol_data(*rank).name.clone()),
            Node::Sin(angle) => self.value(*angle, values, known)?.sin(),
            Node::Cos(angle) => self.value(*angle, values, known)?.cos(),
            Node::Sum(terms) => terms.iter().try_fold(0.0, |sum, (c, term)| {
                Ok::<f64, String>(sum + c.to_f64() * self.value(*term, values, known)?)
            })?,
            Node::Product(factors) => factors.iter().try_fold(1.0, |product, (factor, exponent)| {
                Ok::<f64, String>(product * power(self.value(*factor, values, known)?, *exponent))
            })?,
        };
        known.insert(expr, value);
        Ok(value)
    }
}

/// `base^exponent` by repeated multiplication. `powi` may round differently on another machine, and values become literals in emitted code.
fn power(base: f64, exponent: i32) -> f64 {
    let power = (0..exponent.unsigned_abs()).fold(1.0, |power, _| power * base);
    if exponent < 0 { 1.0 / power } else { power }
}
