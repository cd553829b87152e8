//! Hull storage: the one setting that changes no pixel. It is timed for the recommended settings
//! only.

use ridgelight::gpu::Frame;
use ridgelight::scene::{Hull, Quality};
use ridgelight::{Error, Result};
use ridgelight_trade::statistics::median;

use super::rig::Rig;
use super::walk::KEPT;
use crate::setup::terminal::digits;

/// Timed draws with each storage, each paired with one of the planner's choice, after one to warm
/// up.
const DRAWS: usize = 5;
/// A storage is recommended if it is faster than this ratio and by more than the times vary.
const WORTH: f64 = 0.95;

/// The recommended settings with one hull storage.
pub struct Place {
    pub hull: Hull,
    /// Whether it is the planner's own choice, whose ratio shows how much times vary.
    pub is_own: bool,
    /// Median time ratio to the planner's choice, or why there is none.
    pub ratio: std::result::Result<f64, String>,
}

/// Times each storage. There are none without a hull. A draw is expected to take `draw_s`; three
/// pairs are drawn if they fit into their share of the time, even if that is spent.
///
/// # Errors
/// A storage that changes the picture.
pub fn places(rig: &mut Rig, quality: &Quality, draw_s: f64) -> Result<Vec<Place>> {
    let planned = rig.plan(rig.scene, quality)?;
    // Brute force, exact sweeps and pyramids have no hull.
    let home = planned.settings.iter().find(|(name, _)| name == "hull").map(|(_, hull)| hull);
    let Some(home) = home else { return Ok(Vec::new()) };
    rig.with_frame(quality, |rig, own| {
        rig.gpu.draw(own)?;
        let right = rig.radiance(own)?;
        let one = |hull: Hull| {
            let is_own = hull.to_string() == *home;
            let none = |why: String| Ok(Place { hull, is_own, ratio: Err(why) });
            if 3.0 * draw_s > rig.left().max(rig.share(KEPT) / 3.0) {
                return none("too slow for the rest of the budget".to_owned());
            }
            let mut frame = match rig.frame(&Quality { hull, ..*quality }) {
                Ok(frame) => frame,
                Err(error) => return none(error.to_string()),
            };
            let ratio = ratio(rig, &mut frame, own, &right);
            rig.gpu.end(frame);
            Ok(Place { hull, is_own, ratio: Ok(ratio?) })
        };
        [Hull::Private, Hull::Shared, Hull::OccluderList].into_iter().map(one).collect()
    })
}

fn ratio(rig: &mut Rig, frame: &mut Frame, own: &mut Frame, right: &[Vec<f32>]) -> Result<f64> {
    rig.gpu.draw(frame)?;
    let bits =
        |planes: &[Vec<f32>]| planes.iter().flatten().map(|v| v.to_bits()).collect::<Vec<_>>();
    if bits(&rig.radiance(frame)?) != bits(right) {
        return Err(Error::Device {
            doing: "changing hull storage".into(),
            reason: "the picture changed, which is a bug".into(),
        });
    }
    let mut ratios = Vec::new();
    while ratios.len() < DRAWS && (ratios.is_empty() || rig.left() > 0.0) {
        ratios.push(rig.draw_ns(frame)? / rig.draw_ns(own)?);
    }
    Ok(median(&ratios).unwrap_or(1.0))
}

/// A sentence; none without a hull or without time.
pub fn text(places: &[Place]) -> Option<String> {
    let timed: Vec<(&Place, f64)> =
        places.iter().filter_map(|p| Some((p, *p.ratio.as_ref().ok()?))).collect();
    let spread = timed.iter().find(|(p, _)| p.is_own).map_or(1.0, |(_, r)| r.max(r.recip()));
    let (best, ratio) = timed.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let advice = if !best.is_own && ratio * spread < WORTH {
        format!("add --hull {}", best.hull)
    } else {
        "keep the planner's choice".to_owned()
    };
    let each: Vec<String> = timed
        .iter()
        .map(|(p, ratio)| {
            let own = if p.is_own { " (measured twice)" } else { "" };
            format!("{} {} ×{own}", p.hull, digits(*ratio))
        })
        .collect();
    let untimed = places.iter().filter_map(|p| {
        Some(format!("; --hull {} was not timed: {}", p.hull, p.ratio.as_ref().err()?))
    });
    Some(format!(
        "Hull storage changes the time but not the picture (bit-identical here). Time relative \
            to the planner's choice: {}{}. Advice: {advice}.",
        each.join(", "),
        untimed.collect::<String>()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ratio of 0.97 is not worth a flag; 0.8 is, unless the planner's choice repeated at 1.3 ×
    /// or 1/1.3 of its own time.
    #[test]
    fn advice_needs_a_gain_above_the_noise() {
        let said = |own: f64, other: f64| {
            let places = [
                Place { hull: Hull::Private, is_own: true, ratio: Ok(own) },
                Place { hull: Hull::Shared, is_own: false, ratio: Ok(other) },
                Place { hull: Hull::OccluderList, is_own: false, ratio: Err("late".to_owned()) },
            ];
            text(&places).unwrap()
        };
        assert!(said(1.0, 0.97).ends_with("Advice: keep the planner's choice."));
        assert!(said(1.0, 0.8).ends_with("Advice: add --hull shared."));
        assert!(said(1.3, 0.8).ends_with("choice.") && said(1.0 / 1.3, 0.75).ends_with("choice."));
        let all = said(1.0, 0.8);
        assert!(all.contains("private 1.00 × (measured twice), shared 0.800 ×;"), "{all}");
        assert!(all.contains("--hull occluder-list was not timed: late."), "{all}");
        assert!(text(&[]).is_none());
    }
}
