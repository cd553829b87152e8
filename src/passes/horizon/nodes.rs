//! Sub-sampling: visibility is found at nodes, light at every grid point.

/// Every `stride`-th grid point along each axis, from the first, and the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Nodes {
    /// Grid points from one node to the next: 1, 2, 4, or 8 for later bounces.
    pub stride: u32,
}

impl Nodes {
    /// Number of nodes along an axis of `samples` grid points.
    pub fn count(self, samples: u32) -> u32 {
        (samples - 1).div_ceil(self.stride) + 1
    }

    /// Columns and rows of nodes.
    pub fn size(self, size: [u32; 2]) -> [u32; 2] {
        size.map(|samples| self.count(samples))
    }

    /// The grid point of a node.
    pub fn place(self, node: u32, samples: u32) -> u32 {
        (node * self.stride).min(samples - 1)
    }

    /// The nodes on both sides of a grid point, and its position between them, [0..1].
    pub fn around(self, place: u32, samples: u32) -> ([u32; 2], f64) {
        let low = place / self.stride;
        let high = (low + 1).min(self.count(samples) - 1);
        let [from, to] = [low, high].map(|node| self.place(node, samples));
        let way = f64::from((to - from).max(1));
        ([low, high], f64::from(place - from) / way)
    }
}

#[cfg(test)]
mod tests {
    use super::Nodes;

    #[test]
    fn first_and_last_are_nodes_and_every_sample_lies_between_two() {
        for (stride, samples) in [1, 2, 4, 8].into_iter().flat_map(|s| (1..40).map(move |n| (s, n)))
        {
            let nodes = Nodes { stride };
            let last = nodes.count(samples) - 1;
            assert_eq!([nodes.place(0, samples), nodes.place(last, samples)], [0, samples - 1]);
            for place in 0..samples {
                let ([low, high], t) = nodes.around(place, samples);
                let [from, to] = [low, high].map(|n| f64::from(nodes.place(n, samples)));
                assert!(high <= last && (0.0..=1.0).contains(&t), "{place} of {samples}");
                assert_eq!(from + t * (to - from), f64::from(place));
            }
        }
    }
}
