//! Steps do not allocate: a run of many steps allocates no more than one of few.
#![allow(unsafe_code, reason = "counting allocations takes a global allocator, whose trait is unsafe")]

use rocking::{Column, Method, Motion, Scene, Simulator};
use std::alloc::{GlobalAlloc, Layout, System as SystemAllocator};
use std::cell::Cell;

struct Counting;

thread_local! {
    /// Allocations of this thread: those of the test's harness are its own.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: forwards to the system allocator and counts.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // A thread that ends counts no more.
        let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
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

/// Three drums that lean as one under a weak harmonic: they rock without impact for a while.
fn scene(method: Method, t_end: f64) -> Scene {
    let mut scene = Scene::new(Column::equal_blocks(3, 0.4, 1.6, 1.0, 9.81).expect("valid"));
    scene.excitation.horizontal = Some(Motion::Harmonic { amplitude: 0.1, omega: 300.0, start: 0.0, phase: 0.3 });
    scene.initial.theta = vec![0.1; 3];
    scene.options.method = method;
    scene.options.t_end = t_end;
    scene.options.step = 1e-4;
    scene
}

#[test]
fn steps_do_not_allocate() {
    for &method in Method::ALL {
        let mut simulator = Simulator::new();
        let mut count = |t_end: f64| {
            let scene = scene(method, t_end);
            simulator.run(&scene).expect("solved");
            let before = ALLOCATIONS.get();
            let response = simulator.run(&scene).expect("solved");
            assert!(response.events.is_empty(), "{method:?}: {} events", response.events.len());
            (ALLOCATIONS.get() - before, response.work.steps)
        };
        let ((few, first), (many, last)) = (count(0.02), count(0.1));
        assert!(last > first, "{method:?}: {first} and {last} steps");
        assert!(first < 1000 && few > 0, "the counter counts");
        assert_eq!(many, few, "{method:?}: {first} and {last} steps");
    }
}
