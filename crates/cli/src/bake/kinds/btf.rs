use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight_bake as bake;

use super::super::map::{Format, MapFiles};
use super::far_field::{self, texel};
use super::{Kind, Lit, Making, Map, OfLight, Request, Say, Source};

pub static KIND: Kind = Kind {
    name: "btf",
    about: "an image in the field's own texels for each pair of --angles lights and views: \
        radiance under a light of irradiance 1 facing it, and the share of the view that each \
        texel fills; --bounces 0 omits indirect light",
    encodings: &bake::TEXELS,
    formats: &[Format::Ktx2],
    decoder: include_str!("../../../../../shaders_glsl/decode/btf.glsl"),
    begin,
};

fn begin(request: &Request) -> Result<Making> {
    let count = request.angles.count();
    let name = |pair: usize| {
        let (light, view) = (pair / count, pair % count);
        ["R", "G", "B", "share"].map(|c| format!("btf.{light:04}.{view:04}.{c}"))
    };
    let map = Map {
        planes: (0..count * count).flat_map(name).collect(),
        values: texel(
            "radiance that leaves the texel towards the view under a light of irradiance 1 \
                facing it; 0 where it is not visible",
            "1/sr",
            request,
        ),
        is_array: true,
        constants: far_field::constants("BTF", request.angles),
        ..Map::default()
    };
    let of = OfLight {
        plans: far_field::plans,
        bytes: |lit| far_field::bytes(lit, lit.angles.count()),
        make,
    };
    Ok(Making { map, source: Source::Light(of) })
}

fn make(gpu: &mut Headless, lit: &Lit, files: &mut MapFiles, say: Say) -> Result<()> {
    let count = lit.angles.count();
    let directions = lit.angles.directions()?;
    let facets = far_field::facets(gpu, lit, &directions, say)?;
    let of = (0..count, &(|_| 0..count) as &dyn Fn(usize) -> _);
    far_field::each_light(gpu, lit, &facets, of, &mut |light, radiance| {
        say(format!("light {} of {count}", light + 1));
        for texels in facets.texels_from_all(&radiance) {
            let planes =
                [0, 1, 2, 3].map(|c| -> Vec<f32> { texels.iter().map(|t| t[c] as f32).collect() });
            files.take(&planes.each_ref().map(Vec::as_slice))?;
        }
        Ok(())
    })?;
    far_field::add_entries(files, lit, &facets, far_field::walked(lit)?.as_ref(), true)
}
