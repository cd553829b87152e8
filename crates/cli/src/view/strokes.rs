//! Undo history of brush strokes.

use ridgelight::Result;
use ridgelight::plan::Rectangle;
use ridgelight::scene::HeightField;

use super::brush::together;

/// Strokes that can be undone; older ones are permanent.
const MOST: usize = 64;

/// Heights of a rectangle before and after.
struct Stroke {
    at: Rectangle,
    before: Vec<f32>,
    after: Vec<f32>,
}

#[derive(Default)]
pub struct Strokes {
    done: Vec<Stroke>,
    undone: Vec<Stroke>,
    /// All heights before the current stroke, and the rectangle that it has reached.
    pub begun: Option<(Vec<f32>, Option<Rectangle>)>,
    /// Whether strokes exist that can no longer be undone.
    is_past: bool,
}

impl Strokes {
    pub fn begin(&mut self, field: &HeightField) {
        self.begun = Some((field.heights_m().to_vec(), None));
    }

    pub fn reach(&mut self, at: Rectangle) {
        if let Some((_, all)) = &mut self.begun {
            *all = together(*all, Some(at));
        }
    }

    /// Ends the stroke; clears the redo history.
    pub fn end(&mut self, field: &HeightField) {
        let Some((heights, Some(at))) = self.begun.take() else { return };
        let before = cut(&heights, field.cols(), at);
        let after = cut(field.heights_m(), field.cols(), at);
        self.undone.clear();
        self.done.push(Stroke { at, before, after });
        if self.done.len() > MOST {
            self.done.remove(0);
            self.is_past = true;
        }
    }

    /// Undoes the last stroke. Returns its rectangle.
    pub fn undo(&mut self, field: &mut HeightField) -> Result<Option<Rectangle>> {
        let Some(stroke) = self.done.pop() else { return Ok(None) };
        let at = put(field, stroke.at, &stroke.before)?;
        self.undone.push(stroke);
        Ok(Some(at))
    }

    /// Redoes the last undone stroke.
    pub fn redo(&mut self, field: &mut HeightField) -> Result<Option<Rectangle>> {
        let Some(stroke) = self.undone.pop() else { return Ok(None) };
        let at = put(field, stroke.at, &stroke.after)?;
        self.done.push(stroke);
        Ok(Some(at))
    }

    /// Numbers of strokes that can be undone and redone.
    pub fn count(&self) -> [usize; 2] {
        [self.done.len(), self.undone.len()]
    }

    /// Whether heights differ from the file's, also by the current stroke.
    pub fn have_changed(&self) -> bool {
        let is_drawn = matches!(self.begun, Some((_, Some(_))));
        self.is_past || is_drawn || !self.done.is_empty()
    }
}

fn cut(heights: &[f32], cols: usize, at: Rectangle) -> Vec<f32> {
    let rows = at.row as usize..(at.row + at.rows) as usize;
    let row = |r: usize| &heights[r * cols + at.col as usize..][..at.cols as usize];
    rows.flat_map(row).copied().collect()
}

fn put(field: &mut HeightField, at: Rectangle, heights: &[f32]) -> Result<Rectangle> {
    field.replace([at.row as usize, at.col as usize], at.cols as usize, heights).map(|()| at)
}

#[cfg(test)]
mod tests {
    use super::super::brush::{Action, Brush};
    use super::*;

    #[test]
    fn strokes_are_undone_and_done_again_to_the_bit() {
        let heights: Vec<f64> = (0..400).map(|i| f64::from(i % 7)).collect();
        let mut field = HeightField::new(20, 20, &heights, [1.0; 2], None).unwrap();
        let brush = Brush { radius_m: 3.0, strength: 0.3 };
        let mut strokes = Strokes::default();
        let mut all = vec![field.clone()];
        strokes.begin(&field);
        assert!(!strokes.have_changed());
        for (action, place) in [(Action::Raise, 5.0), (Action::Erode, 9.0), (Action::Lower, 16.0)] {
            strokes.begin(&field);
            for step in [0.0, 1.5] {
                let at = brush.dab(&mut field, action, [place + step, 8.0]).unwrap();
                strokes.reach(at.unwrap());
                assert!(strokes.have_changed(), "{action:?}");
            }
            strokes.end(&field);
            assert!(*all.last().unwrap() != field, "{action:?}");
            all.push(field.clone());
        }
        for before in all[..3].iter().rev() {
            strokes.undo(&mut field).unwrap().unwrap();
            assert!(field == *before);
        }
        assert!(strokes.undo(&mut field).unwrap().is_none() && !strokes.have_changed());
        for after in &all[1..] {
            strokes.redo(&mut field).unwrap().unwrap();
            assert!(field == *after);
        }
        assert!(strokes.redo(&mut field).unwrap().is_none());
        assert_eq!(strokes.count(), [3, 0]);
    }
}
