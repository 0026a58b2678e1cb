//! Joined blocks as one rigid body: how tapered and displaced blocks run on the programs of links.
//!
//! A link moves as one body, whatever blocks it is made of. Its mass, inertia and centroid and the contact above it are all that the
//! equations of motion read, so that one linkage for each number of links serves every pattern.

use super::program::{Geometry, InterfaceEquations};
use crate::column::{Block, Column, Seat};
use crate::numerics::plane::plus;
use rocking_codegen::pattern::Pattern;
use std::ops::Range;

/// Properties of a rigid body. Positions are in the body's own axes, with the origin at the centre of the contact below the body.
#[derive(Clone, Copy, Debug, Default)]
struct Body {
    /// `[kg]`
    mass: f64,
    /// About the centroid `[kg m²]`.
    inertia: f64,
    /// `[m]`
    centroid: [f64; 2],
    /// Centre of the contact above `[m]`.
    top: [f64; 2],
}

impl Body {
    /// These blocks as one body; no blocks give a body without mass and size.
    fn of(column: &Column, blocks: Range<usize>) -> Body {
        let parts = || column.blocks()[blocks.clone()].iter().zip(&column.seats()[blocks.clone()]);
        let mut whole = Body::default();
        let mut moment = [0.0, 0.0];
        for (block, Seat { centroid, top, .. }) in parts() {
            whole.mass += block.mass;
            for axis in 0..2 {
                moment[axis] += block.mass * (whole.top[axis] + centroid[axis]);
                whole.top[axis] += top[axis];
            }
        }
        if whole.mass == 0.0 {
            return whole;
        }
        whole.centroid = moment.map(|moment| moment / whole.mass);
        let mut base = [0.0, 0.0];
        for (Block { mass, inertia, .. }, Seat { centroid, top, .. }) in parts() {
            let lever = [0, 1].map(|axis| base[axis] + centroid[axis] - whole.centroid[axis]);
            whole.inertia += inertia + mass * (lever[0] * lever[0] + lever[1] * lever[1]);
            base = plus(base, *top);
        }
        whole
    }
}

/// The links of a pattern, each a run of blocks. The first link stands on the ground and may be empty.
pub(super) struct Links<'a> {
    column: &'a Column,
    /// Blocks of each link, length dof + 1.
    blocks: Vec<Range<usize>>,
    /// Pivot offset at the base of each link `[m]`; zero for the link on the ground.
    pivots: Vec<f64>,
}

impl<'a> Links<'a> {
    pub fn new(column: &'a Column, pattern: &Pattern) -> Links<'a> {
        let (mut blocks, mut pivots) = (Vec::from([Range { start: 0, end: 0 }]), vec![0.0]);
        for (index, state) in pattern.0.iter().enumerate() {
            if state.is_open() {
                blocks.push(index..index);
                pivots.push(column.pivot_offset(index, *state));
            }
            let own = blocks.len() - 1;
            blocks[own].end = index + 1;
        }
        Links { column, blocks, pivots }
    }

    /// Geometry of all links, from which the scene constants of the linkage follow.
    pub fn whole(&self) -> Geometry<f64> {
        self.geometry(self.blocks.iter().cloned(), self.pivots.clone())
    }

    /// The equations that hold at an interface (numbered from zero), with the geometry that their scene constants read. They are one of `whole`, the equations
    /// of the linkage; or, where the interface lies inside a link, one of `inside`, the equations of divided links.
    pub fn at_interface(
        &self,
        interface: usize,
        whole: &[InterfaceEquations<f64>],
        inside: &[InterfaceEquations<f64>],
    ) -> (InterfaceEquations<f64>, Geometry<f64>) {
        let link = self.blocks.iter().rposition(|blocks| blocks.start <= interface && interface < blocks.end);
        let link = link.expect("every block belongs to a link");
        let Range { start, end } = self.blocks[link];
        if link > 0 && start == interface {
            return (whole[link], self.whole());
        }
        if link == 0 {
            // Blocks on the ground below the interface do not matter.
            let blocks = std::iter::once(interface..end).chain(self.blocks[1..].iter().cloned());
            return (whole[0], self.geometry(blocks, self.pivots.clone()));
        }
        let mut blocks = self.blocks[1..].to_vec();
        blocks.splice(link - 1..link, [start..interface, interface..end]);
        let mut pivots = self.pivots[1..].to_vec();
        pivots.insert(link, 0.0);
        (inside[link - 1], self.geometry(blocks.into_iter(), pivots))
    }

    fn geometry(&self, blocks: impl Iterator<Item = Range<usize>>, pivot: Vec<f64>) -> Geometry<f64> {
        let bodies: Vec<Body> = blocks.map(|blocks| Body::of(self.column, blocks)).collect();
        let each = |size: &dyn Fn(&Body) -> f64| bodies.iter().map(size).collect::<Vec<f64>>();
        Geometry {
            gravity: self.column.gravity(),
            pivot,
            half_height: Vec::new(),
            mass: each(&|body| body.mass),
            inertia: each(&|body| body.inertia),
            centroid_lateral: each(&|body| body.centroid[0]),
            centroid_axial: each(&|body| body.centroid[1]),
            top_lateral: each(&|body| body.top[0]),
            top_axial: each(&|body| body.top[1]),
        }
    }
}
