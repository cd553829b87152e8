//! Sub-sampling: visibility is found at nodes, light at every grid point.

/// Every `stride`-th grid point along each axis, from the first, and the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Nodes {
    /// Grid points from one node to the next: 1, 2, 4, or 8 for later bounces.
    pub stride: u32,
}

impl Nodes {
    /// Number of nodes along an axis of `grid_points` grid points.
    pub fn count(self, grid_points: u32) -> u32 {
        (grid_points - 1).div_ceil(self.stride) + 1
    }

    /// Columns and rows of nodes.
    pub fn size(self, size: [u32; 2]) -> [u32; 2] {
        size.map(|grid_points| self.count(grid_points))
    }

    /// The grid point of a node.
    pub fn place(self, node: u32, grid_points: u32) -> u32 {
        (node * self.stride).min(grid_points - 1)
    }

    /// The nodes on both sides of a grid point, and its position between them, [0..1].
    pub fn around(self, place: u32, grid_points: u32) -> ([u32; 2], f64) {
        let low = place / self.stride;
        let high = (low + 1).min(self.count(grid_points) - 1);
        let [from, to] = [low, high].map(|node| self.place(node, grid_points));
        let way = f64::from((to - from).max(1));
        ([low, high], f64::from(place - from) / way)
    }
}

#[cfg(test)]
mod tests {
    use super::Nodes;

    #[test]
    fn first_and_last_are_nodes_and_every_sample_lies_between_two() {
        for (stride, grid_points) in
            [1, 2, 4, 8].into_iter().flat_map(|s| (1..40).map(move |n| (s, n)))
        {
            let nodes = Nodes { stride };
            let last = nodes.count(grid_points) - 1;
            assert_eq!(
                [nodes.place(0, grid_points), nodes.place(last, grid_points)],
                [0, grid_points - 1]
            );
            for place in 0..grid_points {
                let ([low, high], t) = nodes.around(place, grid_points);
                let [from, to] = [low, high].map(|n| f64::from(nodes.place(n, grid_points)));
                assert!(high <= last && (0.0..=1.0).contains(&t), "{place} of {grid_points}");
                assert_eq!(from + t * (to - from), f64::from(place));
            }
        }
    }
}
