//! Many scenes from one: axes over the keys of a base scene, a scene for each point. Each point follows from its index alone.

use super::axes::{Axis, Combine};
use super::outcome::Ask;
use crate::scene::{Scene, Wanted};
use crate::scene_file::{SceneFileError, Setting, Template};
use std::collections::HashSet;
use std::ops::{ControlFlow, Range};

/// A base scene and what varies.
#[derive(Debug)]
pub struct Sweep {
    /// The base scene.
    pub template: Template,
    /// What varies.
    pub axes: Vec<Axis>,
    /// How the axes make points.
    pub combine: Combine,
    /// What is asked.
    pub ask: Ask,
}

/// As [`Sweep::evenly_spread`], of some of the points.
fn evenly_spread(points: Range<usize>, most: usize) -> impl Iterator<Item = usize> {
    let count = points.len().min(most);
    let steps = (count.max(2) - 1) as u128;
    (0..count).map(move |place| points.start + ((points.len() - 1) as u128 * place as u128 / steps) as usize)
}

impl Sweep {
    /// Number of points; the largest number there is if there are more.
    pub fn len(&self) -> usize {
        let lengths = |axes: &[Axis]| axes.iter().map(|axis| axis.values.len()).collect::<Vec<_>>();
        match self.combine {
            Combine::Paired => lengths(&self.axes).into_iter().min().unwrap_or(0),
            _ => lengths(self.grid()).into_iter().fold(self.samples().unwrap_or(1), usize::saturating_mul),
        }
    }

    /// Numbers of points spread evenly over the sweep, the first and the last among them: all if there are no more than `most`, otherwise as many.
    pub fn evenly_spread(&self, most: usize) -> impl Iterator<Item = usize> + use<> {
        evenly_spread(0..self.len(), most)
    }

    /// Warnings, a sentence each, each once: about axes, and about the scenes of these points ([`Scene::warnings`]), of all of them or of `most` evenly spread ones.
    ///
    /// # Panics
    /// If the sweep has no such points.
    pub fn warnings(&self, points: Range<usize>, most: usize) -> Vec<String> {
        self.warnings_observed(points, most, || ControlFlow::Continue(()))
    }

    /// As [`Sweep::warnings`]; `progress` is called before each scene is read, and a break ends with the warnings so far.
    ///
    /// # Panics
    /// If the sweep has no such points.
    pub fn warnings_observed(
        &self,
        points: Range<usize>,
        most: usize,
        mut progress: impl FnMut() -> ControlFlow<()>,
    ) -> Vec<String> {
        let read = evenly_spread(points, most).take_while(|_| progress().is_continue());
        let scenes = read.filter_map(|point| self.scene(point).ok());
        let mut seen = HashSet::new();
        let all =
            self.axes.iter().filter_map(|axis| self.rescaled(axis)).chain(scenes.flat_map(|scene| scene.warnings()));
        all.filter(|warning| seen.insert(warning.clone())).collect()
    }

    /// The key of the base scene whose place an axis takes: `amplitude` for an axis over `amplitude_g`. `None` for an axis over a key that is there, or new.
    pub fn replaced(&self, axis: &Axis) -> Option<String> {
        self.template.stand_in(&axis.key)
    }

    /// Warning of an axis of factors that takes the place of a size to which the base scene scales its record.
    fn rescaled(&self, axis: &Axis) -> Option<String> {
        let size = self.replaced(axis).filter(|_| axis.key.ends_with(".scale"))?;
        Some(format!(
            "the axis {} takes the place of {size} in the base scene: it multiplies the record as its file has it",
            axis.key
        ))
    }

    /// The axes that are not sampled.
    pub fn grid(&self) -> &[Axis] {
        self.parts().0
    }

    /// Number of samples for each combination of the other axes; `None` for a sweep without distributions.
    pub fn samples(&self) -> Option<usize> {
        self.parts().1.iter().map(|axis| axis.values.len()).min()
    }

    /// The axes that are not sampled, and those that are.
    fn parts(&self) -> (&[Axis], &[Axis]) {
        let sampled = if let Combine::Sampled(count) = self.combine { count } else { 0 };
        self.axes.split_at(self.axes.len().saturating_sub(sampled))
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Values of the axes at a point, in their order.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn settings(&self, index: usize) -> Vec<&Setting> {
        let mut settings = Vec::new();
        self.put_settings(index, &mut settings);
        settings
    }

    /// Replaces the contents of `settings` by the values of the axes at a point, in their order.
    pub(super) fn put_settings<'s>(&'s self, index: usize, settings: &mut Vec<&'s Setting>) {
        assert!(index < self.len(), "point {index} of a sweep that has {}", self.len());
        settings.clear();
        if self.combine == Combine::Paired {
            settings.extend(self.axes.iter().map(|axis| &axis.values[index]));
            return;
        }
        let ((grid, sampled), samples) = (self.parts(), self.samples().unwrap_or(1));
        let (mut rest, sample) = (index / samples, index % samples);
        settings.extend(sampled.iter().rev().map(|axis| &axis.values[sample]));
        settings.extend(grid.iter().rev().map(|axis| {
            let value = &axis.values[rest % axis.values.len()];
            rest /= axis.values.len();
            value
        }));
        settings.reverse();
    }

    /// The scene of a point as the sweep runs it: without rows, its options `wanted` and `record_forces` as [`Sweep::ask`] needs them.
    ///
    /// # Errors
    /// [`SceneFileError`]
    ///
    /// # Panics
    /// If there is no such point.
    pub fn scene(&self, index: usize) -> Result<Scene, SceneFileError> {
        self.scene_of(&self.settings(index))
    }

    /// As [`Sweep::scene`], of values of the axes, in their order.
    pub(super) fn scene_of(&self, settings: &[&Setting]) -> Result<Scene, SceneFileError> {
        let keys = self.axes.iter().map(|axis| axis.key.as_str());
        let mut scene = self.template.without_rows(keys.zip(settings.iter().copied()))?;
        scene.options.wanted = match self.ask {
            Ask::Outcome => Wanted::Outcome,
            Ask::Overturns => Wanted::Overturns,
            Ask::Peaks | Ask::Slides | Ask::Validity | Ask::Trust => Wanted::Everything,
        };
        scene.options.record_forces = self.ask == Ask::Validity;
        Ok(scene)
    }
}
