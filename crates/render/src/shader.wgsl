// Surfaces, balls and ground under many small lights, each with a shadow map; see lights.rs and
// renderer/mod.rs.

// The view of the camera or of a light.
struct View {
    matrix: mat4x4<f32>,
    // The eye of the camera with w = 1, or the direction toward a light with w = 0.
    eye: vec4<f32>,
}

struct Light {
    // To texture coordinates and depth in the shadow map, in [0, 1].
    matrix: mat4x4<f32>,
    // Direction toward the light; w: 1 if it belongs to the key light.
    direction: vec4<f32>,
    // Linear light; w: unused.
    radiance: vec4<f32>,
}

struct Scene {
    // Linear colors of the backdrop at the upper and lower edge; upper.w: height of the picture [pixels].
    upper: vec4<f32>,
    lower: vec4<f32>,
    // Irradiance of a level ground with nothing on it.
    open_sky: vec4<f32>,
    // Center and radius of a ball that contains all casters of shadows.
    bound: vec4<f32>,
    // Number of lights; width of a texel of the shadow maps [m] as the bits of an f32; 0; 0.
    counts: vec4<u32>,
    palette: array<vec4<f32>, 256>,
    lights: array<Light, 96>,
}

@group(0) @binding(0) var<uniform> view: View;
@group(1) @binding(0) var<uniform> scene: Scene;
@group(1) @binding(1) var shadows: texture_depth_2d_array;
@group(1) @binding(2) var shadow_sampler: sampler_comparison;

// Light from everywhere, so that nothing is black, and more of it from below, reflected by the ground.
const AMBIENT: f32 = 0.05;
const BOUNCE: f32 = 0.16;

// Light at a point: the irradiance, and the visible share and mean direction of the key light.
struct Received {
    diffuse: vec3<f32>,
    key: f32,
    key_direction: vec3<f32>,
}

fn received(point: vec3<f32>, normal: vec3<f32>) -> Received {
    let texel = bitcast<f32>(scene.counts.y);
    var sum = vec3<f32>(0.0);
    var key_seen = 0.0;
    var key_count = 0.0;
    var key_direction = vec3<f32>(0.0);
    for (var k = 0u; k < scene.counts.x; k++) {
        let direction = scene.lights[k].direction;
        let cosine = dot(normal, direction.xyz);
        key_count += direction.w;
        key_direction += direction.w * direction.xyz;
        if cosine > 0.0 {
            // Offset from the surface by some texels, more at grazing angles, so that it does not shade
            // itself.
            let start = point + normal * (texel * (1.0 + 1.5 * (1.0 - cosine))) + direction.xyz * texel;
            let at = (scene.lights[k].matrix * vec4<f32>(start, 1.0)).xyz;
            var seen = 1.0;
            if all(at.xy > vec2<f32>(0.0)) && all(at.xy < vec2<f32>(1.0)) {
                // Only ground lies beyond the depth of the map; casters in the map may shade it.
                seen = textureSampleCompareLevel(shadows, shadow_sampler, at.xy, k, clamp(at.z, 0.0, 1.0));
            }
            sum += scene.lights[k].radiance.rgb * (cosine * seen);
            key_seen += direction.w * seen;
        }
    }
    return Received(sum, key_seen / max(key_count, 1.0), normalize(key_direction + vec3<f32>(0.0, 0.0, 1e-6)));
}

// Light that a surface of this color sends to the eye.
fn shade(color: vec3<f32>, point: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let light = received(point, normal);
    let ambient = AMBIENT + BOUNCE * (0.5 - 0.5 * normal.z);
    var out = color * (light.diffuse + ambient);
    // A weak highlight (Blinn, 1977) shows the shape.
    let to_eye = normalize(view.eye.xyz - point);
    let middle = normalize(light.key_direction + to_eye);
    out += vec3<f32>(0.07 * light.key * pow(max(dot(normal, middle), 0.0), 28.0));
    // Bright colors are compressed instead of clipped.
    let knee = vec3<f32>(0.7);
    let over = max(out - knee, vec3<f32>(0.0));
    return min(out, knee) + 0.3 * (1.0 - exp(-over / 0.3));
}

// The color of a value in [0, 1]; a negative value has the color of the body.
fn colored(value: f32, own: vec3<f32>) -> vec3<f32> {
    if value < 0.0 {
        return own;
    }
    let at = clamp(value, 0.0, 1.0) * 255.0;
    let low = u32(at);
    return mix(scene.palette[low].rgb, scene.palette[min(low + 1u, 255u)].rgb, fract(at));
}

fn linear(srgb: vec3<f32>) -> vec3<f32> {
    return select(pow((srgb + 0.055) / 1.055, vec3<f32>(2.4)), srgb / 12.92, srgb <= vec3<f32>(0.04045));
}

// ---- surfaces and tubes

struct SurfaceIn {
    @location(0) point: vec3<f32>,
    @location(1) value: f32,
    @location(2) normal: vec3<f32>,
    @location(3) color: vec4<f32>,
}

struct SurfaceOut {
    @builtin(position) position: vec4<f32>,
    @location(0) point: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) value: f32,
    // w: 1 if the colors of the two sides differ.
    @location(3) color: vec4<f32>,
}

@vertex
fn surface_vertex(in: SurfaceIn) -> SurfaceOut {
    let position = view.matrix * vec4<f32>(in.point, 1.0);
    return SurfaceOut(position, in.point, in.normal, in.value, vec4<f32>(linear(in.color.rgb), in.color.a));
}

@fragment
fn surface_fragment(in: SurfaceOut, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    var normal = normalize(in.normal);
    var own = in.color.rgb;
    if !front {
        normal = -normal;
        // The back is paler, so that folds can be seen.
        let gray = vec3<f32>(dot(own, vec3<f32>(0.2126, 0.7152, 0.0722)));
        own = mix(own, mix(own, gray, 0.35) * 0.55 + 0.3, in.color.a);
    }
    return vec4<f32>(shade(colored(in.value, own), in.point, normal), 1.0);
}

// ---- balls: squares that face the viewer; each fragment intersects its ray with the ball

struct BallIn {
    @location(0) center: vec3<f32>,
    @location(1) radius: f32,
    @location(2) value: f32,
    @location(3) color: vec4<f32>,
}

struct BallOut {
    @builtin(position) position: vec4<f32>,
    @location(0) point: vec3<f32>,
    @location(1) @interpolate(flat) ball: vec4<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
}

// The square of a ball without its color: the pass of a light has no access to the palette.
fn ball_square(in: BallIn, index: u32) -> BallOut {
    // Direction from the center of the ball toward the viewer, and the radius of its outline in the plane of
    // the square.
    var toward = view.eye.xyz;
    var size = in.radius;
    if view.eye.w > 0.5 {
        let way = view.eye.xyz - in.center;
        let distance = max(length(way), 1.001 * in.radius);
        toward = way / distance;
        size = in.radius * distance / sqrt(distance * distance - in.radius * in.radius);
    }
    // Room for smooth edges.
    size *= 1.15;
    let axis = select(vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(1.0, 0.0, 0.0), abs(toward.z) > 0.7);
    let right = normalize(cross(axis, toward));
    let up = cross(toward, right);
    let corner = vec2<f32>(vec2<u32>(index & 1u, index >> 1u)) * 2.0 - 1.0;
    let point = in.center + (right * corner.x + up * corner.y) * size;
    let position = view.matrix * vec4<f32>(point, 1.0);
    return BallOut(position, point, vec4<f32>(in.center, in.radius), vec4<f32>(0.0));
}

@vertex
fn ball_vertex(in: BallIn, @builtin(vertex_index) index: u32) -> BallOut {
    var out = ball_square(in, index);
    out.color = vec4<f32>(colored(in.value, linear(in.color.rgb)), 1.0);
    return out;
}

@vertex
fn ball_outline_vertex(in: BallIn, @builtin(vertex_index) index: u32) -> BallOut {
    return ball_square(in, index);
}

// The point where the ray through a point of the square meets the ball; w: distance of the ray from the
// center. A ray that misses gives the point of the ball nearest to it.
fn ball_hit(point: vec3<f32>, ball: vec4<f32>) -> vec4<f32> {
    var along = -view.eye.xyz;
    if view.eye.w > 0.5 {
        along = normalize(point - view.eye.xyz);
    }
    let relative = point - ball.xyz;
    let nearest = relative - along * dot(relative, along);
    let aside = length(nearest);
    let back = sqrt(max(ball.w * ball.w - aside * aside, 0.0));
    let on_ball = nearest * min(1.0, ball.w / max(aside, 1e-12)) - along * back;
    return vec4<f32>(ball.xyz + on_ball, aside);
}

struct BallPixel {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn ball_fragment(in: BallOut) -> BallPixel {
    let hit = ball_hit(in.point, in.ball);
    // The share of the pixel that the ball covers; it masks the samples.
    let coverage = clamp(0.5 + (in.ball.w - hit.w) / max(fwidth(hit.w), 1e-12), 0.0, 1.0);
    let clip = view.matrix * vec4<f32>(hit.xyz, 1.0);
    if coverage <= 0.0 {
        discard;
    }
    let normal = normalize(hit.xyz - in.ball.xyz);
    return BallPixel(vec4<f32>(shade(in.color.rgb, hit.xyz, normal), coverage), clip.z / clip.w);
}

@fragment
fn ball_shadow(in: BallOut) -> @builtin(frag_depth) f32 {
    let hit = ball_hit(in.point, in.ball);
    if hit.w > in.ball.w {
        discard;
    }
    let clip = view.matrix * vec4<f32>(hit.xyz, 1.0);
    return clip.z / clip.w;
}

// ---- backdrop and ground

fn backdrop(y: f32) -> vec3<f32> {
    return mix(scene.upper.rgb, scene.lower.rgb, smoothstep(0.0, 1.0, y / scene.upper.w));
}

@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(vec2<u32>((index << 1u) & 2u, index & 2u)) * 2.0 - 1.0;
    return vec4<f32>(corner, 0.5, 1.0);
}

@fragment
fn backdrop_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(backdrop(position.y), 1.0);
}

// The ground has the color of the backdrop, darkened by the light that is blocked, so that it has no edge
// and no horizon. Ground that is not level is darker as far as it faces away from the light.
@fragment
fn ground_fragment(in: SurfaceOut) -> @location(0) vec4<f32> {
    let light = received(in.point, normalize(in.normal)).diffuse;
    let share = (light + AMBIENT) / (scene.open_sky.rgb + AMBIENT);
    let distance = length(in.point - scene.bound.xyz) / scene.bound.w;
    let fade = 1.0 - smoothstep(2.5, 6.0, distance);
    return vec4<f32>(backdrop(in.position.y) * mix(vec3<f32>(1.0), min(share, vec3<f32>(1.0)), fade), 1.0);
}
