//! Expressions as Rust tokens, shared parts as `let`s.

use super::layout::remark;
use super::number::number;
use crate::symbolic::{Arena, Expr, Node, Rational};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use std::collections::{BTreeSet, HashMap};

/// Names and comments of a [`Writer`].
pub trait Style {
    /// Tokens that read a symbol.
    fn symbol(&self, name: &str) -> TokenStream {
        let name = format_ident!("{name}");
        quote! { #name }
    }

    /// Name of a sub-expression that is used more than once or as a divisor. With `None`, it gets a numbered name such as `shared_1`.
    fn shared(&self, _arena: &Arena, _part: Expr) -> Option<String> {
        None
    }

    /// Comment before the `let` of a value. `names` holds the sub-expressions that already have a name.
    fn remark(&self, _arena: &Arena, _value: Expr, _names: &HashMap<Expr, Ident>) -> Option<String> {
        None
    }
}

/// Writes a sequence of named values. A sub-expression that is used more than once gets a name, and so does the reciprocal of every divisor.
pub struct Writer<'a, Names: Style> {
    arena: &'a Arena,
    style: &'a Names,
    names: HashMap<Expr, Ident>,
    /// Names of reciprocals, by divisor.
    reciprocals: HashMap<Expr, Ident>,
    uses: HashMap<Expr, usize>,
    /// The values to be bound, now or later, by their names. No other sub-expression may take one of these names.
    reserved: HashMap<&'a str, Expr>,
    numbers: BTreeSet<usize>,
    lets: Vec<TokenStream>,
    unnamed: usize,
}

/// Numbers that are written as words: `(number of halves, word)`.
const WORDS: [(usize, &str); 5] = [(1, "half"), (4, "two"), (6, "three"), (8, "four"), (16, "eight")];

impl<'a, Names: Style> Writer<'a, Names> {
    /// A writer for the values `named`, each to be bound to its name, and for `others`, which are only read.
    pub fn new(
        arena: &'a Arena,
        named: impl IntoIterator<Item = (&'a str, Expr)>,
        others: &[Expr],
        style: &'a Names,
    ) -> Writer<'a, Names> {
        let reserved: Vec<(&str, Expr)> = named.into_iter().collect();
        let mut uses = HashMap::new();
        for &value in reserved.iter().map(|(_, value)| value).chain(others) {
            count_uses(arena, value, &mut uses);
        }
        Writer {
            arena,
            style,
            names: HashMap::new(),
            reciprocals: HashMap::new(),
            uses,
            reserved: reserved.into_iter().collect(),
            numbers: BTreeSet::new(),
            lets: Vec::new(),
            unnamed: 0,
        }
    }

    /// `let name = value;`
    pub fn bind(&mut self, name: &str, symbol: Expr, value: Expr) {
        let tokens = self.read(value);
        let ident = format_ident!("{name}");
        if tokens.to_string() != name {
            self.add_let(&ident, value, tokens);
        }
        self.names.insert(symbol, ident);
    }

    /// A comment before the next `let`.
    pub fn heading(&mut self, text: &str) {
        self.lets.push(remark(text));
    }

    /// The tokens of a value, after writing the `let`s that the value needs.
    pub fn read(&mut self, expr: Expr) -> TokenStream {
        match self.arena.node(expr).clone() {
            // A value that is nothing but a reciprocal needs no `let` here: the caller binds or returns it.
            Node::Product(factors) if matches!(factors[..], [(_, -1)]) && !self.names.contains_key(&expr) => {
                let divisor = self.factor(factors[0].0);
                let known = self.reciprocals.get(&factors[0].0);
                known.map_or_else(|| quote! { #divisor.recip() }, |name| quote! { #name })
            }
            _ => self.tokens(expr, true),
        }
    }

    /// All `let`s: first those of the numbers written as words, then the others.
    pub fn finish(self) -> Vec<TokenStream> {
        let numbers = self.numbers.iter().map(|&index| {
            let (halves, word) = WORDS[index];
            let (name, value) = (format_ident!("{word}"), number(halves as f64 / 2.0));
            quote! { let #name = S::from_f64(#value); }
        });
        numbers.chain(self.lets).collect()
    }

    fn add_let(&mut self, name: &Ident, value: Expr, tokens: TokenStream) {
        let remark = self.style.remark(self.arena, value, &self.names).map(|text| remark(&text));
        self.lets.push(quote! { #remark let #name = #tokens; });
    }

    fn tokens(&mut self, expr: Expr, outermost: bool) -> TokenStream {
        if let Some(name) = self.arena.symbol_name(expr) {
            return self.style.symbol(name);
        }
        if let Some(name) = self.names.get(&expr) {
            return quote! { #name };
        }
        let tokens = match self.arena.node(expr).clone() {
            Node::Number(value) => return self.number(value),
            Node::Symbol(_) => unreachable!("symbols are read above"),
            Node::Sin(_) | Node::Cos(_) => unreachable!("sines and cosines are inputs of a program"),
            Node::Product(factors) => self.product(&factors),
            Node::Sum(terms) => self.sum(&terms),
        };
        if outermost || self.uses.get(&expr).is_none_or(|uses| *uses < 2) {
            return tokens;
        }
        let name = self.name_shared(expr);
        self.add_let(&name, expr, tokens);
        self.names.insert(expr, name.clone());
        quote! { #name }
    }

    fn name_shared(&mut self, expr: Expr) -> Ident {
        let name = self.style.shared(self.arena, expr);
        let is_free = |name: &String| {
            !self.names.values().any(|known| known == name)
                && self.reserved.get(name.as_str()).is_none_or(|value| *value == expr)
        };
        let name = name.filter(is_free).unwrap_or_else(|| {
            self.unnamed += 1;
            format!("shared_{}", self.unnamed)
        });
        format_ident!("{name}")
    }

    fn product(&mut self, factors: &[(Expr, i32)]) -> TokenStream {
        let mut product = TokenStream::new();
        for &(factor, power) in factors {
            let part = if power < 0 { self.reciprocal(factor) } else { self.factor(factor) };
            for _ in 0..power.unsigned_abs() {
                product = if product.is_empty() {
                    part.clone()
                } else {
                    quote! { #product * #part }
                };
            }
        }
        product
    }

    fn factor(&mut self, factor: Expr) -> TokenStream {
        let tokens = self.tokens(factor, false);
        let is_compound = !self.names.contains_key(&factor) && matches!(self.arena.node(factor), Node::Sum(_));
        if is_compound {
            quote! { (#tokens) }
        } else {
            tokens
        }
    }

    /// The name of `1 / divisor`, which is computed once.
    fn reciprocal(&mut self, divisor: Expr) -> TokenStream {
        if !self.reciprocals.contains_key(&divisor) {
            let tokens = self.factor(divisor);
            let of = match (self.names.get(&divisor), self.arena.symbol_name(divisor)) {
                (Some(name), _) => name.to_string(),
                (None, Some(name)) => name.into(),
                (None, None) => self.name_shared(divisor).to_string(),
            };
            let name = format_ident!("inverse_{of}");
            self.lets.push(quote! { let #name = #tokens.recip(); });
            self.reciprocals.insert(divisor, name);
        }
        let name = &self.reciprocals[&divisor];
        quote! { #name }
    }

    fn sum(&mut self, terms: &[(Rational, Expr)]) -> TokenStream {
        let mut tokens = TokenStream::new();
        // A positive term, if there is one, comes first: this saves a negation.
        let leader = terms.iter().position(|(coefficient, _)| !coefficient.is_negative()).unwrap_or(0);
        let order = std::iter::once(leader).chain((0..terms.len()).filter(|index| *index != leader));
        for (position, index) in order.enumerate() {
            let (coefficient, term) = terms[index];
            let size = if coefficient.is_negative() { -coefficient } else { coefficient };
            let body = match self.arena.node(term) {
                Node::Number(_) => self.number(size),
                _ => {
                    let term = self.tokens(term, false);
                    if size == Rational::ONE {
                        term
                    } else {
                        let size = self.number(size);
                        quote! { #size * #term }
                    }
                }
            };
            tokens = match (position, coefficient.is_negative()) {
                (0, false) => body,
                (0, true) if body.clone().into_iter().count() == 1 => quote! { -#body },
                (0, true) => quote! { -(#body) },
                (_, false) => quote! { #tokens + #body },
                (_, true) => quote! { #tokens - #body },
            };
        }
        tokens
    }

    fn number(&mut self, value: Rational) -> TokenStream {
        let halves = value.numerator * 2 / value.denominator;
        let is_exact = halves * value.denominator == value.numerator * 2;
        match WORDS.iter().position(|(known, _)| is_exact && i64::try_from(*known) == Ok(halves)) {
            Some(index) => {
                self.numbers.insert(index);
                let name = format_ident!("{}", WORDS[index].1);
                quote! { #name }
            }
            None => {
                let value = number(value.to_f64());
                quote! { S::from_f64(#value) }
            }
        }
    }
}

/// Counts how often each node is read. The operands of a node are counted only once, on the first visit to that node.
fn count_uses(arena: &Arena, expr: Expr, uses: &mut HashMap<Expr, usize>) {
    let seen = uses.entry(expr).or_insert(0);
    *seen += 1;
    if *seen > 1 {
        return;
    }
    arena.operands(expr).for_each(|part| count_uses(arena, part, uses));
    // A power reads its base several times.
    if let Node::Product(factors) = arena.node(expr) {
        factors
            .iter()
            .filter(|(_, power)| power.unsigned_abs() > 1)
            .for_each(|(base, _)| count_uses(arena, *base, uses));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::{Level, Unit};

    struct Plain;

    impl Style for Plain {}

    /// `a + b.recip()` would be another number.
    #[test]
    fn the_reciprocal_of_a_sum_has_brackets() {
        let mut arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.symbol(name, Level::State, Unit::default()));
        let sum = arena.add(a, b);
        let reciprocal = arena.reciprocal(sum);
        let tokens = Writer::new(&arena, [], &[reciprocal], &Plain).read(reciprocal);
        assert_eq!(tokens.to_string(), "(a + b) . recip ()");
    }
}
