//! Expressions as Rust tokens, shared parts as `let`s.

use super::number;
use crate::symbolic::{Arena, Expr, Node, Rational};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use std::collections::HashMap;

/// Writes a sequence of named values; what is used more than once and has no name gets one.
pub struct Writer<'a> {
    arena: &'a Arena,
    names: HashMap<Expr, Ident>,
    reads: Box<dyn Fn(&str) -> TokenStream + 'a>,
    uses: HashMap<Expr, usize>,
    lets: Vec<TokenStream>,
    shared: usize,
}

impl<'a> Writer<'a> {
    /// A writer for these values; `reads` says how a symbol is read.
    pub fn new(
        arena: &'a Arena,
        values: impl IntoIterator<Item = Expr>,
        reads: impl Fn(&str) -> TokenStream + 'a,
    ) -> Writer<'a> {
        let mut uses = HashMap::new();
        for value in values {
            count_uses(arena, value, &mut uses);
        }
        Writer { arena, names: HashMap::new(), reads: Box::new(reads), uses, lets: Vec::new(), shared: 0 }
    }

    /// `let name = value;`
    pub fn bind(&mut self, name: &str, symbol: Expr, value: Expr) {
        let tokens = self.read(value);
        let ident = format_ident!("{name}");
        self.lets.push(quote! { let #ident = #tokens; });
        self.names.insert(symbol, ident);
    }

    /// The tokens of a value; `let`s that it needs are written before.
    pub fn read(&mut self, expr: Expr) -> TokenStream {
        self.tokens(expr, true)
    }

    /// The `let`s so far.
    pub fn finish(self) -> Vec<TokenStream> {
        self.lets
    }

    fn tokens(&mut self, expr: Expr, outermost: bool) -> TokenStream {
        if let Some(name) = self.names.get(&expr) {
            return quote! { #name };
        }
        let tokens = match self.arena.node(expr).clone() {
            Node::Number(value) => constant(value),
            Node::Symbol(rank) => return (self.reads)(&self.arena.symbol_data(rank).name),
            Node::Sin(_) | Node::Cos(_) => unreachable!("sines and cosines are inputs of a program"),
            Node::Product(factors) => self.product(&factors),
            Node::Sum(terms) => self.sum(&terms),
        };
        let is_shared =
            self.uses.get(&expr).is_some_and(|uses| *uses > 1) && !matches!(self.arena.node(expr), Node::Number(_));
        if is_shared && !outermost {
            self.shared += 1;
            let name = format_ident!("shared_{}", self.shared);
            self.lets.push(quote! { let #name = #tokens; });
            self.names.insert(expr, name.clone());
            return quote! { #name };
        }
        tokens
    }

    fn product(&mut self, factors: &[(Expr, i32)]) -> TokenStream {
        let mut parts = Vec::new();
        for &(factor, power) in factors {
            let base = self.tokens(factor, false);
            let is_compound = !self.names.contains_key(&factor) && matches!(self.arena.node(factor), Node::Sum(_));
            let base = if is_compound {
                quote! { (#base) }
            } else {
                base
            };
            for _ in 0..power.unsigned_abs() {
                parts.push(if power < 0 {
                    quote! { #base.recip() }
                } else {
                    base.clone()
                });
            }
        }
        let mut product = TokenStream::new();
        for (position, part) in parts.iter().enumerate() {
            product.extend(if position == 0 {
                quote! { #part }
            } else {
                quote! { * #part }
            });
        }
        product
    }

    fn sum(&mut self, terms: &[(Rational, Expr)]) -> TokenStream {
        let mut tokens = TokenStream::new();
        // A positive term leads where there is one: it saves a negation.
        let leader = terms.iter().position(|(coefficient, _)| !coefficient.is_negative()).unwrap_or(0);
        let order = std::iter::once(leader).chain((0..terms.len()).filter(|index| *index != leader));
        for (position, index) in order.enumerate() {
            let (coefficient, term) = terms[index];
            let size = if coefficient.is_negative() { -coefficient } else { coefficient };
            let body = match self.arena.node(term) {
                Node::Number(_) => constant(size),
                _ => {
                    let term = self.tokens(term, false);
                    if size == Rational::ONE {
                        term
                    } else {
                        let size = constant(size);
                        quote! { #size * #term }
                    }
                }
            };
            tokens = match (position, coefficient.is_negative()) {
                (0, false) => body,
                (0, true) => quote! { -(#body) },
                (_, false) => quote! { #tokens + #body },
                (_, true) => quote! { #tokens - #body },
            };
        }
        tokens
    }
}

fn constant(value: Rational) -> TokenStream {
    let value = number(value.to_f64());
    quote! { S::from_f64(#value) }
}

/// Counts how often each compound node is read, its children once per distinct node.
fn count_uses(arena: &Arena, expr: Expr, uses: &mut HashMap<Expr, usize>) {
    let seen = uses.entry(expr).or_insert(0);
    *seen += 1;
    if *seen > 1 {
        return;
    }
    match arena.node(expr) {
        Node::Number(_) | Node::Symbol(_) | Node::Sin(_) | Node::Cos(_) => {}
        Node::Sum(terms) => terms.iter().for_each(|(_, term)| count_uses(arena, *term, uses)),
        Node::Product(factors) => {
            for (factor, power) in factors {
                count_uses(arena, *factor, uses);
                // A power reads its base several times.
                if power.unsigned_abs() > 1 {
                    count_uses(arena, *factor, uses);
                }
            }
        }
    }
}
