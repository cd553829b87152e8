//! A plan run pass by pass.

use std::collections::BTreeSet;
use std::ops::Range;

use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan::{Azimuth, Kind, Pass, Plan, ResourceId};
use ridgelight::scene::{Border, Directions, Fuse, PhongSpecular, Quality, Scene, VisiblePoints};
use ridgelight_cpu::lattice::{Lattice, Lattices, number_layers};
use ridgelight_cpu::path_trace::Traced;
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::specular_gather::Series;
use ridgelight_cpu::tolerance::ShadeError;

use super::{Case, Pair, edit, reference_of};

/// A plan run pass by pass, and the outputs of its passes so far.
pub(crate) struct Run<'a> {
    pub gpu: &'a mut Headless,
    pub frame: Frame,
    pub plan: Plan,
    pub scene: &'a Scene,
    pub quality: Quality,
    /// The device's sweeps by azimuth, as lattices of one layer.
    pub lattices: Vec<Option<Lattice>>,
    /// First azimuth of each light summed so far. A GPU plan may alternate between lights.
    light_begins: BTreeSet<usize>,
    /// The sum of the lights so far, by the CPU reference, and how many they are.
    pub radiance: Vec<[f64; 3]>,
    pub lights: usize,
    /// The sum of the sphere lights so far, by the CPU reference, and each texel's bound.
    pub sphere_lights: Vec<([f64; 3], f64)>,
    /// The output of the specular passes so far.
    pub specular: Vec<[f64; 3]>,
    /// The arriving light that is bounced, as series.
    pub arriving: Vec<Series>,
    /// Groups of four lines whose hull was deeper than its storage.
    pub lost: usize,
    pub edit: Option<edit::Edit>,
    /// Of visible points.
    pub directions: Option<Directions>,
    /// Of scattered light.
    pub points: Option<VisiblePoints>,
    /// Of a list of texels.
    pub listed: Option<Vec<usize>>,
    /// Of every pixel, the batch of paths that is being traced.
    pub batches: Vec<Traced>,
    /// The mean so far, by the CPU reference, and its bound.
    pub scattered: Vec<([f64; 3], [f64; 3])>,
}

impl<'a> Run<'a> {
    /// The first azimuth of the light that a pass adds to. `first` is the first azimuth of the pass; `clears` is set if it starts
    /// the sum.
    pub fn begin_of_light(&mut self, first: usize, clears: bool) -> usize {
        if clears {
            self.light_begins.insert(first);
        }
        *self.light_begins.range(..=first).next_back().expect("a sum that has begun")
    }

    pub fn new(gpu: &'a mut Headless, case: &'a Case) -> Self {
        let plan = case.plan(&crate::limits_of(gpu));
        let contents = case.contents();
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        let mut frame = gpu.frame(plan.clone(), &contents).expect("a frame");
        gpu.draw(&mut frame).expect("drawn");
        Self {
            gpu,
            frame,
            scene: &case.scene,
            quality: case.quality,
            lattices: vec![None; plan.azimuths.len()],
            light_begins: BTreeSet::new(),
            radiance: Vec::new(),
            lights: 0,
            sphere_lights: Vec::new(),
            specular: Vec::new(),
            arriving: Vec::new(),
            lost: 0,
            edit: None,
            directions: case.directions(),
            points: case.points(),
            listed: case.listed(),
            batches: Vec::new(),
            scattered: Vec::new(),
            plan,
        }
    }

    /// Runs every pass alone, in order, and pairs its output with the CPU reference's.
    pub fn pairs(&mut self) -> Vec<(String, Vec<Pair>)> {
        let passes = self.plan.passes.clone();
        let mut all = Vec::new();
        for (i, pass) in passes.iter().enumerate() {
            self.gpu.draw_passes(&mut self.frame, &[i]).expect("drawn");
            all.push((pass.label(), reference_of(pass)(self, pass)));
        }
        if !self.plan.edit_passes.is_empty() {
            self.edit = Some(edit::draw(self));
            let finds_horizons =
                ["dirty_mark", "height_transpose", "horizon_resweep", "dirty_list"];
            let passes = self.plan.edit_passes.clone();
            for pass in passes.iter().filter(|p| finds_horizons.contains(&p.name())) {
                all.push((format!("edit: {}", pass.label()), reference_of(pass)(self, pass)));
            }
        }
        all
    }

    /// The resource of a binding, or of its form in f16.
    pub fn bound(pass: &Pass, binding: &str) -> Option<ResourceId> {
        let at = |name: &str| pass.shader.bindings.iter().position(|b| b.name == name);
        let place = at(binding).unwrap_or_else(|| panic!("{} binds no {binding}", pass.name()));
        let half = at(&format!("{binding}_f16"));
        pass.bindings[place].or_else(|| pass.bindings[half?])
    }

    /// Words of the resource that the pass binds under this name, if any.
    pub fn words(&mut self, pass: &Pass, binding: &str) -> Option<Vec<u32>> {
        let id = Self::bound(pass, binding)?;
        Some(self.gpu.read(&self.frame, id).expect("read back"))
    }

    pub fn floats(&mut self, pass: &Pass, binding: &str) -> Option<Vec<f32>> {
        Some(self.words(pass, binding)?.into_iter().map(f32::from_bits).collect())
    }

    /// Columns and rows of the image that the pass binds under this name.
    pub fn extent(&self, pass: &Pass, binding: &str) -> [usize; 2] {
        let id = Self::bound(pass, binding).expect("bound");
        match self.plan.resources[id.0].kind {
            Kind::Image { width, height, .. } => [width as usize, height as usize],
            Kind::Buffer { .. } => panic!("{binding} is a buffer"),
        }
    }

    pub fn size(&self) -> [usize; 2] {
        [self.scene.field.cols(), self.scene.field.rows()]
    }

    pub fn phong_specular(&self, grid_point: usize) -> PhongSpecular {
        self.scene.surface.specular.as_ref().expect("a specular").at(grid_point)
    }

    pub fn directions(&self) -> Directions {
        self.directions.clone().expect("a case with directions")
    }

    /// On a curved base.
    pub fn bent_directions(&self) -> Directions {
        match &self.points {
            Some(points) => points.directions().clone(),
            None => self.directions(),
        }
    }

    pub fn border(&self) -> Border {
        self.scene.surface.border
    }

    pub fn heights(&self) -> Heights<'a> {
        let scene = self.scene;
        Heights::of(&scene.field, scene.surface.border)
    }

    /// The largest |height| and the relief.
    pub fn relief(&self) -> [f64; 2] {
        let all = || self.scene.field.heights_m().iter().map(|h| f64::from(*h));
        let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
        [low.abs().max(high.abs()), high - low]
    }

    /// What errs at a texel whatever its horizons.
    pub fn texel_error(&self) -> ShadeError {
        let [x, y] = self.scene.field.cell_m();
        ShadeError::new(0.0, self.relief()[1], x.min(y), 1)
    }

    /// How far a normal may be turned, radians.
    pub fn normal_error(&self) -> f64 {
        self.texel_error().normal()
    }

    pub fn warm_up(&self, marches_rows: bool) -> i32 {
        let batch = ridgelight::plan::Axis::of(marches_rows, self.plan.size, self.border());
        batch.warm_up as i32
    }

    /// What the sweeps of some azimuths left, for the CPU references of later passes.
    pub fn swept<T>(
        &self,
        azimuths: Range<usize>,
        (fuse, line_shift): (Option<Fuse>, u32),
        of: impl FnOnce(&Swept) -> T,
    ) -> T {
        let mut list: Vec<Azimuth> = self.plan.azimuths[azimuths.clone()].to_vec();
        number_layers(&mut list);
        let shift = if fuse.is_none() { 15 } else { line_shift };
        let mut lattices = Lattices::new(&list, self.size(), shift, self.border());
        for (azimuth, left) in list.iter().zip(&self.lattices[azimuths]) {
            let left = left.as_ref().expect("swept before");
            let all = lattices.of_mut(azimuth);
            let begin = all.texel(0, 0, azimuth.layer);
            let texels = begin..begin + left.slopes.len();
            all.occluders[texels.clone()].copy_from_slice(&left.occluders);
            all.slopes[texels.clone()].copy_from_slice(&left.slopes);
            all.distances[texels].copy_from_slice(&left.distances);
        }
        of(&Swept {
            heights: self.heights(),
            azimuths: &list,
            lattices: &lattices,
            fuse,
            line_shift,
            warm_up: [self.warm_up(false), self.warm_up(true)],
        })
    }
}
