//! A right-hand side and a step do not allocate.
#![allow(unsafe_code, reason = "counting allocations takes a global allocator, whose trait is unsafe")]

use rocking::dynamics::{Dynamics, Ground};
use rocking::generated::GeneratedMode;
use rocking::generated::equations::{Dof3, linkage};
use rocking::lanes::Lanes;
use rocking::ode::{
    Accurate, AtNodes, Dop853, DormandPrince54, Gauss, Interpolant, Pair, SecondOrder, States, System, Tolerance,
};
use rocking::pattern::Pattern;
use rocking::{Column, GroundMotion};
use std::alloc::{GlobalAlloc, Layout, System as SystemAllocator};
use std::sync::atomic::{AtomicUsize, Ordering};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: forwards to the system allocator and counts.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::SeqCst);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { SystemAllocator.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the pointer came from `alloc` above.
        unsafe { SystemAllocator.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

struct Mode(GeneratedMode<Dof3>);

impl System for Mode {
    type State = [f64; 6];

    fn slope(&mut self, t: f64, x: &[f64; 6], slope: &mut [f64; 6]) {
        self.0.derivative(x, Ground { x: t, gravity: 9.81 }, slope);
    }
}

impl SecondOrder for Mode {
    type State = [f64; 6];
    type Links = [f64; 3];

    fn go_to(&mut self, _: f64, _: AtNodes) {}

    fn acceleration(&mut self, states: States<'_>, acceleration: &mut [AtNodes]) {
        self.0.accelerations(states, [Lanes([1.0; 8]), Lanes([9.81; 8])], acceleration);
    }
}

fn collocation(system: &mut Mode) -> f64 {
    let mut x = [0.01, 0.02, 0.03, 0.1, 0.0, -0.1];
    let mut gauss = Gauss::new(&x, &[0.0; 3]);
    let tolerance = Tolerance { rtol: 1e-9, atol: 1e-12 };
    let error = gauss.attempt(system, 0.0, &x.clone(), 0.05, tolerance, Accurate::Throughout);
    gauss.state_inside(0.5, &mut x);
    error + x[0]
}

fn step<P: Pair<[f64; 6]>>(system: &mut Mode, interpolant: &mut Interpolant<[f64; 6]>) -> f64 {
    let x = [0.01, 0.02, 0.03, 0.1, 0.0, -0.1];
    let mut pair = P::new(&x);
    let mut slope = [0.0; 6];
    system.slope(0.0, &x, &mut slope);
    let error = pair.attempt(system, 0.0, &x, &slope, 0.01, Tolerance { rtol: 1e-9, atol: 1e-12 });
    pair.accept(system);
    pair.interpolate(system, interpolant);
    let mut inside = x;
    interpolant.evaluate(0.5, &mut inside);
    error + inside[0]
}

#[test]
fn a_step_does_not_allocate() {
    let column = Column::equal_blocks(3, 0.4, 1.6, 1.0, 9.81).expect("valid");
    let mode =
        GeneratedMode::<Dof3>::new(&column, &Pattern::from_signs(&[1, 1, 1]), GroundMotion::WithVertical, linkage)
            .expect("three free angles");
    let mut system = Mode(mode);
    let mut interpolant = Interpolant::new(&[0.0; 6]);
    let before = ALLOCATIONS.load(Ordering::SeqCst);
    let results = [
        step::<Dop853<[f64; 6]>>(&mut system, &mut interpolant),
        step::<DormandPrince54<[f64; 6]>>(&mut system, &mut interpolant),
        collocation(&mut system),
    ];
    let after = ALLOCATIONS.load(Ordering::SeqCst);
    assert!(results.iter().all(|result| result.is_finite()));
    assert_eq!(after - before, 0);
    assert!(before > 0, "the counter counts");
}
