//! Settings that would be refused, found before any is measured.

use super::ladders::{Ladder, Place};

/// Places that are refused whatever their counts are, with the reason.
///
/// `why` is called for places that differ from the defaults in one or two choices: no known refusal
/// needs three, and none depends on a count within its range. Every place with a refused
/// combination is refused, too.
pub fn refused(
    ladders: &[Ladder],
    places: &[Place],
    mut why: impl FnMut(&Place) -> Option<String>,
) -> Vec<(usize, String)> {
    let mut known: Vec<(Vec<(usize, usize)>, String)> = Vec::new();
    let others = |place: &Place| -> Vec<(usize, usize)> {
        let steps = place.steps.iter().enumerate();
        steps
            .filter_map(|(k, s)| Some((k, (*s)?)))
            .filter(|(k, s)| ladders[*k].default != *s)
            .collect()
    };
    let has = |place: &Place, steps: &[(usize, usize)]| {
        steps.iter().all(|(ladder, step)| place.steps[*ladder] == Some(*step))
    };
    for count in 1..=2 {
        for place in places {
            let steps = others(place);
            let is_choice = steps.iter().all(|(ladder, _)| ladders[*ladder].range.is_none());
            let is_known = known.iter().any(|(of, _)| has(place, of));
            if steps.len() == count && is_choice && !is_known {
                known.extend(why(place).map(|why| (steps, why)));
            }
        }
    }
    let of = |place: &Place| known.iter().find(|(steps, _)| has(place, steps));
    let all = places.iter().enumerate();
    all.filter_map(|(i, place)| Some((i, of(place)?.1.clone()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trade::{ladders, places, start};
    use ridgelight::scene::{
        Fuse, HeightField, Lights, Lines, Method, Precision, Scene, Sun, Surface,
    };

    /// Under a sky and a sun exact lines are refused, and here packed heights with the slopes'
    /// fuse: every place with either, and no other, by few calls.
    #[test]
    fn refusals_cover_all_counts() {
        let sun =
            Sun { azimuth_rad: 0.0, elevation_rad: 0.5, diameter_rad: 0.01, irradiance: [1.0; 3] };
        let scene = Scene {
            field: HeightField::new(2, 2, &[0.0; 4], [1.0; 2], None).unwrap(),
            surface: Surface::default(),
            lights: Lights { sky: Some([1.0; 3]), suns: vec![sun], ..Lights::default() },
        };
        let ladders = ladders(&scene, 0);
        let places = places(&ladders, &start());
        let why = |place: &Place| {
            let quality = &place.quality;
            let is_swept = !matches!(quality.method, Method::BruteForce | Method::Pyramid);
            let two = quality.fuse == Fuse::Slopes && quality.precision == Precision::Packed;
            if is_swept && quality.lines == Lines::Exact {
                Some("exact".to_owned())
            } else {
                (is_swept && two).then(|| "packed".to_owned())
            }
        };
        let mut checked = 0;
        let found = refused(&ladders, &places, |place| {
            checked += 1;
            why(place)
        });
        let all = places.iter().enumerate();
        let expected: Vec<_> = all.filter_map(|(i, p)| Some((i, why(p)?))).collect();
        assert_eq!(found, expected);
        assert!(found.len() > 100 && checked < 60, "{} of {checked}", found.len());
    }
}
