//! Indirect light at every grid point: the ground's share of its own hemisphere, times the mean radiance of the
//! ground visible from the nodes around it.

use crate::Rgb;
use crate::sh_shade::nodes_around;
use crate::shared::sweep::Heights;
use ridgelight::plan::Nodes;

/// Least divisor where a texel's share is larger than the nodes': below it, theirs may be numerical noise.
pub const LEAST_SHARE: f64 = 1.0 / 256.0;

/// Light of one grid point, for albedo 1, from that of all nodes and from all grid points' light under a sky of
/// radiance 1.
pub fn bounce_shade(
    heights: &Heights,
    nodes: Nodes,
    (light, sky_share): (&[Rgb], &[f64]),
    [col, row]: [i32; 2],
) -> Rgb {
    let size = [heights.cols as u32, heights.rows as u32];
    let across = nodes.count(size[0]);
    let share =
        |col: u32, row: u32| (1.0 - sky_share[row as usize * heights.cols + col as usize]).max(0.0);
    let (mut sum, mut around) = ([0.0; 3], 0.0);
    for ([x, y], weight) in nodes_around(heights, nodes, [col, row]) {
        let node = light[(y * across + x) as usize];
        sum = [0, 1, 2].map(|c| sum[c] + weight * node[c]);
        around += weight * share(nodes.place(x, size[0]), nodes.place(y, size[1]));
    }
    let own = share(col as u32, row as u32);
    let ratio = match own >= around {
        true => 1.0 + (own - around) / around.max(LEAST_SHARE),
        false => own / around,
    };
    sum.map(|s| s * ratio)
}
