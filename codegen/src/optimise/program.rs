//! Programs: scene constants pulled out, the rest as named statements over the state.
//!
//! A [`ProgramBuilder`] translates expressions of the derivation into the arena of the program. Every scene expression, however large, becomes
//! one constant. Programs name no length or mass, so that programs of different linkages can be compared. A constant without a given name is
//! named by the state factors that it multiplies and by the quantities in its formula, so that equal programs have equal names. Constants
//! stand in the order of their first use.

use super::count::{Operations, count_expressions};
use crate::mechanics::{Symbols, Vector};
use crate::symbolic::{Arena, Expr, Level, Node, Rational, Unit};
use std::collections::HashMap;
use std::fmt;

/// Rule that names a constant, given the inputs and statements that the constant multiplies, outermost first, and its formula in the derivation.
type ConstantName = Box<dyn Fn(&[String], &Arena, Expr) -> Option<String>>;

/// A scene constant of a program.
#[derive(Clone, Debug)]
pub struct Constant {
    /// Name in the emitted code.
    pub name: String,
    /// Its symbol in the program's arena.
    pub symbol: Expr,
    /// Unit of the constant.
    pub unit: Unit,
    /// Its formula, in the arena of the derivation.
    pub source: Expr,
}

/// `name = value`
#[derive(Clone, Debug)]
pub struct Statement {
    /// Name of the intermediate.
    pub name: String,
    /// Its symbol in the program's arena.
    pub symbol: Expr,
    /// Its value in the program's arena.
    pub value: Expr,
}

/// A straight-line routine over inputs and scene constants.
#[derive(Clone, Debug)]
pub struct Routine {
    /// Name of the function emitted.
    pub name: &'static str,
    /// Intermediates in order of evaluation.
    pub statements: Vec<Statement>,
    /// Results, in the program's arena.
    pub outputs: Vec<Expr>,
}

impl Routine {
    /// Values of the statements, then the outputs.
    pub fn values(&self) -> impl Iterator<Item = Expr> {
        self.statements.iter().map(|statement| statement.value).chain(self.outputs.iter().copied())
    }

    /// Leaves out statements that the outputs do not need.
    fn drop_unused(&mut self, arena: &Arena) {
        let mut needed = self.outputs.clone();
        let mut kept = Vec::with_capacity(self.statements.len());
        for statement in self.statements.drain(..).rev() {
            if needed.iter().any(|&value| occurs(arena, value, statement.symbol)) {
                needed.push(statement.value);
                kept.push(statement);
            }
        }
        kept.reverse();
        self.statements = kept;
    }
}

/// Routines that share their scene constants.
#[derive(Debug)]
pub struct Program {
    /// Free angles.
    pub dof: usize,
    /// Arena of the statements' expressions.
    pub arena: Arena,
    /// Scene constants, in the order in which the emitted code receives them.
    pub constants: Vec<Constant>,
    /// The routines.
    pub routines: Vec<Routine>,
}

impl Program {
    /// Text of all statements and outputs. Programs with equal texts are the same function of their constants and inputs.
    pub fn fingerprint(&self) -> String {
        let mut text = format!("dof {} constants {}\n", self.dof, self.constants.len());
        for routine in &self.routines {
            text.push_str(routine.name);
            text.push('\n');
            for statement in &routine.statements {
                text.push_str(&format!("{} = {}\n", statement.name, self.arena.text(statement.value)));
            }
            for output in &routine.outputs {
                text.push_str(&format!("-> {}\n", self.arena.text(*output)));
            }
        }
        text
    }

    /// Replaces symbols by values in all routines. A statement whose value has become a symbol, the opposite of one, or a number is inlined;
    /// statements that are no longer needed are left out.
    pub fn rewrite(&mut self, mut replacement: HashMap<Expr, Expr>) {
        for routine in &mut self.routines {
            let mut kept = Vec::with_capacity(routine.statements.len());
            for mut statement in routine.statements.drain(..) {
                statement.value = self.arena.substitute(statement.value, &replacement);
                if is_plain(&self.arena, statement.value) {
                    replacement.insert(statement.symbol, statement.value);
                } else {
                    kept.push(statement);
                }
            }
            for output in &mut routine.outputs {
                *output = self.arena.substitute(*output, &replacement);
            }
            routine.statements = kept;
            routine.drop_unused(&self.arena);
        }
    }

    /// Puts a statement before all others of the routines that use it.
    pub fn prepend(&mut self, name: &str, symbol: Expr, value: Expr) {
        for routine in &mut self.routines {
            routine.statements.insert(0, Statement { name: name.into(), symbol, value });
            routine.drop_unused(&self.arena);
        }
    }

    /// Leaves out constants that no routine reads.
    pub fn drop_unused_constants(&mut self) {
        let is_read = |symbol: Expr| {
            self.routines.iter().flat_map(Routine::values).any(|value| occurs(&self.arena, value, symbol))
        };
        let read: Vec<Expr> = self.constants.iter().map(|constant| constant.symbol).filter(|s| is_read(*s)).collect();
        self.constants.retain(|constant| read.contains(&constant.symbol));
    }

    /// Operations of one call of a routine.
    pub fn operations(&self, routine: &str) -> Option<Operations> {
        let routine = self.routines.iter().find(|candidate| candidate.name == routine)?;
        Some(count_expressions(&self.arena, routine.values()))
    }
}

/// Builds a [`Program`] from expressions of a derivation.
pub struct ProgramBuilder<'a> {
    /// The arena of the derivation.
    pub source: &'a mut Arena,
    program: Program,
    /// Expressions of the source that have a symbol in the program: inputs, constants, named statements.
    known: HashMap<Expr, Expr>,
    statements: Vec<Statement>,
    /// Inputs and statements that multiply the expression being translated, outermost first.
    factors: Vec<String>,
    constant_name: ConstantName,
}

impl fmt::Debug for ProgramBuilder<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ProgramBuilder").field("program", &self.program).finish_non_exhaustive()
    }
}

impl<'a> ProgramBuilder<'a> {
    /// A builder whose inputs are `cos_a, sin_a, omega_a, alpha_a, cos_ddot_a, sin_ddot_a, ground_x, gravity`.
    pub fn new(source: &'a mut Arena, symbols: &Symbols) -> ProgramBuilder<'a> {
        let dof = symbols.theta.len();
        let mut arena = Arena::new();
        let mut known = HashMap::new();
        let mut input = |name: String, of: Expr, source: &Arena| {
            let symbol = arena.symbol(name, Level::State, source.unit(of));
            known.insert(of, symbol);
        };
        for (family, index) in ["cos", "sin", "omega", "alpha"].iter().flat_map(|f| (0..dof).map(move |i| (f, i))) {
            let of = match *family {
                "cos" => source.cos(symbols.theta[index]),
                "sin" => source.sin(symbols.theta[index]),
                "omega" => symbols.omega[index],
                _ => symbols.alpha[index],
            };
            input(format!("{family}_{}", index + 1), of, source);
        }
        for link in 0..dof {
            input(format!("cos_ddot_{}", link + 1), symbols.cos_ddot[link], source);
            input(format!("sin_ddot_{}", link + 1), symbols.sin_ddot[link], source);
        }
        input("ground_x".into(), symbols.ground_x, source);
        input("gravity".into(), symbols.gravity, source);
        let program = Program { dof, arena, constants: Vec::new(), routines: Vec::new() };
        let constant_name: ConstantName = Box::new(|_, _, _| None);
        ProgramBuilder { source, program, known, statements: Vec::new(), factors: Vec::new(), constant_name }
    }

    /// A further input that stands for an expression of the derivation.
    pub fn input(&mut self, name: String, of: Expr) {
        let unit = self.source.unit(of);
        let symbol = self.program.arena.symbol(name, Level::State, unit);
        self.known.insert(of, symbol);
    }

    /// Sets the rule that names constants without a given name from now on. If the rule gives `None`, the name is `coefficient_of_` and the factors.
    pub fn name_constants_by(&mut self, rule: impl Fn(&[String], &Arena, Expr) -> Option<String> + 'static) {
        self.constant_name = Box::new(rule);
    }

    /// The program's arena.
    pub fn arena(&mut self) -> &mut Arena {
        &mut self.program.arena
    }

    /// The constant that stands for a scene expression, or minus the constant that stands for its opposite. If there is neither, a new constant
    /// with this unit, called `name`, or `other_` and `name` if that name is taken.
    pub fn constant(&mut self, scene: Expr, name: &str, unit: Unit) -> Expr {
        if let Some(&symbol) = self.known.get(&scene) {
            return symbol;
        }
        let opposite = self.source.neg(scene);
        if let Some(&symbol) = self.known.get(&opposite) {
            return self.program.arena.neg(symbol);
        }
        let mut name = name.to_string();
        while self.program.constants.iter().any(|constant| constant.name == name) {
            name.insert_str(0, "other_");
        }
        let symbol = self.program.arena.symbol(name.as_str(), Level::Scene, unit);
        self.program.constants.push(Constant { name, symbol, unit, source: scene });
        self.known.insert(scene, symbol);
        symbol
    }

    /// Translates an expression of the derivation into inputs, constants and named statements of the program.
    pub fn translate(&mut self, expr: Expr) -> Expr {
        if let Some(&known) = self.known.get(&expr) {
            return known;
        }
        let opposite = self.source.neg(expr);
        if let Some(&known) = self.known.get(&opposite) {
            return self.program.arena.neg(known);
        }
        if self.source.level(expr) == Level::Scene {
            let unit = self.source.unit(expr);
            let name = (self.constant_name)(&self.factors, self.source, expr);
            let name = name.unwrap_or_else(|| format!("coefficient_of_{}", self.factors.join("_")));
            return self.constant(expr, &name, unit);
        }
        match self.source.node(expr).clone() {
            Node::Number(value) => self.program.arena.number(value),
            Node::Product(factors) => self.translate_product(&factors, Rational::ONE),
            Node::Sum(terms) => {
                let (state, scene): (Vec<_>, Vec<_>) =
                    terms.into_iter().partition(|(_, term)| self.source.level(*term) == Level::State);
                let mut translated = Vec::new();
                for (coefficient, term) in state {
                    let factors = self.source.factors(term);
                    translated.push(self.translate_product(&factors, coefficient));
                }
                let scene = self.source.sum(scene);
                translated.push(self.translate_scene(scene));
                self.program.arena.total(translated)
            }
            Node::Symbol(_) | Node::Sin(_) | Node::Cos(_) => {
                unreachable!("every state symbol of a derivation is an input of the program or substituted before")
            }
        }
    }

    /// `coefficient · Π factors`, the scene factors and the number joined to one constant.
    fn translate_product(&mut self, factors: &[(Expr, i32)], coefficient: Rational) -> Expr {
        let (state, scene): (Vec<_>, Vec<_>) =
            factors.iter().copied().partition(|(factor, _)| self.source.level(*factor) == Level::State);
        let scene = self.source.product(scene);
        let weighted = self.source.scale(coefficient, scene);
        let outer = self.factors.len();
        let names = state.iter().filter_map(|(factor, _)| self.name_of(*factor)).collect::<Vec<_>>();
        self.factors.extend(names);
        let mut translated = vec![(self.translate_scene(weighted), 1)];
        for (factor, power) in state {
            translated.push((self.translate(factor), power));
        }
        self.factors.truncate(outer);
        self.program.arena.product(translated)
    }

    fn translate_scene(&mut self, scene: Expr) -> Expr {
        match self.source.node(scene) {
            Node::Number(value) => {
                let value = *value;
                self.program.arena.number(value)
            }
            _ => self.translate(scene),
        }
    }

    /// Name of the input or statement that stands for a factor of the derivation; `None` if there is none.
    fn name_of(&self, factor: Expr) -> Option<String> {
        Some(self.program.arena.symbol_name(*self.known.get(&factor)?)?.into())
    }

    /// Adds a statement that names a value, and returns its symbol. A value that is a symbol, the opposite of one, or a number is returned as it is.
    pub fn define(&mut self, name: String, value: Expr) -> Expr {
        if is_plain(&self.program.arena, value) {
            return value;
        }
        let unit = self.program.arena.unit(value);
        let symbol = self.program.arena.symbol(name.clone(), Level::State, unit);
        self.statements.push(Statement { name, symbol, value });
        symbol
    }

    /// From now on, translates the symbol `source` of the derivation into `value`.
    pub fn alias(&mut self, source: Expr, value: Expr) {
        self.known.insert(source, value);
    }

    /// Translates an expression of the derivation and names the result. Later translations of the expression, or of its opposite, read the name.
    pub fn define_translated(&mut self, name: String, expr: Expr) -> Expr {
        let value = self.translate(expr);
        let symbol = self.define(name, value);
        self.known.insert(expr, symbol);
        symbol
    }

    /// Names the components of `vector`: the derivative, by the angle of `link` (from 1), of a body vector turned by this angle. The constants of
    /// `vector` are named `*_axial` (along the axis of the link) and `*_lateral` (across the axis), and begin with `prefix`.
    pub fn define_turned_vector(&mut self, prefix: &str, name: &str, link: usize, vector: Vector) {
        for (coefficient, term) in self.source.terms(vector[0]) {
            let factors = self.source.factors(term);
            let along = factors.iter().any(|(factor, _)| matches!(self.source.node(*factor), Node::Cos(_)));
            let scene: Vec<_> =
                factors.into_iter().filter(|(factor, _)| self.source.level(*factor) == Level::Scene).collect();
            let scene = self.source.product(scene);
            let scene = self.source.scale(coefficient, scene);
            if self.source.level(scene) == Level::Scene {
                let unit = self.source.unit(scene);
                let axis = if along { "axial" } else { "lateral" };
                self.constant(scene, &format!("{prefix}{name}_{axis}_{link}"), unit);
            }
        }
        for (axis, component) in ["x", "y"].iter().zip(vector) {
            self.define_translated(format!("{name}_{axis}_{link}"), component);
        }
    }

    /// Closes a routine. It consists of those statements since the previous routine that the outputs need.
    pub fn finish_routine(&mut self, name: &'static str, outputs: Vec<Expr>) {
        let statements = std::mem::take(&mut self.statements);
        for statement in &statements {
            self.known.retain(|_, value| !occurs(&self.program.arena, *value, statement.symbol));
        }
        let mut routine = Routine { name, statements, outputs };
        routine.drop_unused(&self.program.arena);
        self.program.routines.push(routine);
    }

    /// The finished program.
    pub fn finish(mut self) -> Program {
        self.program.drop_unused_constants();
        self.program
    }
}

/// Whether an expression is a number or a symbol, or one of these with a minus sign.
fn is_plain(arena: &Arena, expr: Expr) -> bool {
    match arena.node(expr) {
        Node::Symbol(_) | Node::Number(_) => true,
        Node::Sum(terms) => match terms.as_slice() {
            [(coefficient, term)] => *coefficient == -Rational::ONE && is_plain(arena, *term),
            _ => false,
        },
        _ => false,
    }
}

/// Whether `symbol` occurs in `expr`.
fn occurs(arena: &Arena, expr: Expr, symbol: Expr) -> bool {
    arena.any(expr, &|part| part == symbol)
}
