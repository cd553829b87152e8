//! What a picture to write holds.

/// One layer of a picture to write.
#[derive(Clone, Debug)]
pub struct Layer<'a> {
    /// Prefix of the channels' names with a dot, as compositors expect: "direct.sky" gives
    /// "direct.sky.R". Empty for the main layer, whose channels have no prefix.
    pub name: String,
    /// The samples.
    pub channels: Channels<'a>,
}

impl<'a> Layer<'a> {
    /// One channel without a prefix.
    pub fn scalar(name: &'a str, values: &'a [f32]) -> Self {
        Self { name: String::new(), channels: Channels::Scalar(name, values) }
    }

    /// The full name of one of its channels.
    pub(crate) fn channel(&self, name: &str) -> String {
        match (self.name.as_str(), name) {
            ("", name) | (name, "") => name.to_owned(),
            (layer, name) => format!("{layer}.{name}"),
        }
    }
}

/// The samples of a [`Layer`], row-major, NaN allowed.
#[derive(Clone, Copy, Debug)]
pub enum Channels<'a> {
    /// Linear red, green and blue as R, G and B.
    Rgb(&'a [[f32; 3]]),
    /// One value per pixel under a name, as "Y" or "Z". An empty name leaves only the layer's.
    Scalar(&'a str, &'a [f32]),
}

impl Channels<'_> {
    pub(super) fn len(&self) -> usize {
        match self {
            Channels::Rgb(texels) => texels.len(),
            Channels::Scalar(_, values) => values.len(),
        }
    }
}
