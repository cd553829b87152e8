// Draws a height field with the light of Ridgelight: white ground's radiance under the sun and under the sky, times
// their colours and the ground's.

#import bevy_pbr::mesh_functions
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::view_transformations::position_world_to_clip

#ifdef TONEMAP_IN_SHADER
#import bevy_core_pipeline::tonemapping::tone_mapping
#endif

struct Terrain {
    base: vec4<f32>,
    sun: vec4<f32>,  // illuminance, lux
    sky: vec4<f32>,  // luminance, cd/m²
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> terrain: Terrain;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var heights: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var sun: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var sky: texture_2d<f32>;

struct Vertex {
    @builtin(instance_index) instance_index: u32,
    @location(0) position: vec3<f32>,
    @location(2) uv: vec2<f32>,
}

struct VertexOutput {
    @builtin(position) clip: vec4<f32>,
    @location(0) at: vec2<f32>,
}

@vertex
fn vertex(vertex: Vertex) -> VertexOutput {
    let at = vertex.uv * vec2<f32>(textureDimensions(heights) - 1u);
    let height = textureLoad(heights, vec2<i32>(round(at)), 0).r;
    let world_from_local = mesh_functions::get_world_from_local(vertex.instance_index);
    let place = vec4<f32>(vertex.position.x, vertex.position.y + height, vertex.position.z, 1.0);
    let world = mesh_functions::mesh_position_local_to_world(world_from_local, place);
    return VertexOutput(position_world_to_clip(world.xyz), at);
}

// Linear between grid points.
fn bilinear(image: texture_2d<f32>, at: vec2<f32>) -> f32 {
    let last = vec2<i32>(textureDimensions(image)) - 1;
    let a = clamp(vec2<i32>(floor(at)), vec2<i32>(0), last);
    let b = min(a + 1, last);
    let t = at - vec2<f32>(a);
    let north = mix(textureLoad(image, a, 0).r, textureLoad(image, vec2<i32>(b.x, a.y), 0).r, t.x);
    let south = mix(textureLoad(image, vec2<i32>(a.x, b.y), 0).r, textureLoad(image, b, 0).r, t.x);
    return mix(north, south, t.y);
}

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    let light = terrain.sun.rgb * bilinear(sun, in.at) + terrain.sky.rgb * bilinear(sky, in.at);
    var colour = vec4<f32>(terrain.base.rgb * light * view.exposure, 1.0);
#ifdef TONEMAP_IN_SHADER
    colour = tone_mapping(colour, view.color_grading);
#endif
    return colour;
}
