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
    // Tangents of angles along right and up of its map: xy: from its direction to the middle of its part; z: radius of
    // the part; w: unused.
    part: vec4<f32>,
}

struct Scene {
    // Linear colors of the backdrop at the upper and lower edge; upper.w: height of the picture [pixels].
    upper: vec4<f32>,
    lower: vec4<f32>,
    // Irradiance of a level ground with nothing on it.
    open_sky: vec4<f32>,
    // Center and radius of a ball that contains all casters of shadows.
    bound: vec4<f32>,
    // Number of lights; width of a texel of the shadow maps [m] as the bits of an f32; number of key lights, which
    // come first, plus 256 times the points of each that are looked up in penumbras; 1 if
    // pixels are reduced four at a time.
    counts: vec4<u32>,
    // Points spread evenly over a disc; z, w: unused.
    disc: array<vec4<f32>, 16>,
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

// Distance from which on casters count as no farther, in sides of the shadow maps.
const FARTHEST: f32 = 8.0;

// Light at a point: the irradiance, and the visible share and mean direction of the key light.
struct Received {
    diffuse: vec3<f32>,
    key: f32,
    key_direction: vec3<f32>,
}

// Where a point with this normal is looked up in the shadow map of a light: offset from the surface by some
// texels, more at grazing angles, so that it does not shade itself. Coordinates and depth share one unit.
fn place_in_map(k: u32, point: vec3<f32>, normal: vec3<f32>, cosine: f32) -> vec3<f32> {
    let texel = bitcast<f32>(scene.counts.y);
    let start = point + normal * (texel * (1.0 + 1.5 * (1.0 - cosine))) + scene.lights[k].direction.xyz * texel;
    return (scene.lights[k].matrix * vec4<f32>(start, 1.0)).xyz;
}

// How far the nearest caster in a shadow map lies before a place in it, 0 if none does.
fn caster(k: u32, at: vec3<f32>) -> f32 {
    if any(at.xy <= vec2<f32>(0.0)) || any(at.xy >= vec2<f32>(1.0)) {
        return 0.0;
    }
    let side = vec2<f32>(textureDimensions(shadows));
    let depth = textureLoad(shadows, vec2<u32>(at.xy * side), k, 0);
    // Only ground lies beyond the depth of the map; casters in the map may shade it.
    return select(0.0, at.z - depth, depth < min(at.z, 1.0));
}

// The share of the part of a light in the direction `offset` from its middle [tangents of angles] that is seen
// past casters at the distance `way`. What is much nearer the receiver does not count: it would shade itself.
fn seen_past(k: u32, at: vec3<f32>, offset: vec2<f32>, way: f32) -> f32 {
    let place = at.xy + offset * way * vec2<f32>(1.0, -1.0);
    return textureSampleCompareLevel(shadows, shadow_sampler, place, k, clamp(at.z - 0.5 * way, 0.0, 1.0));
}

// The light of the sky where each light casts a hard edge.
fn hard_sky(point: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var k = scene.counts.z & 0xffu; k < scene.counts.x; k++) {
        let cosine = dot(normal, scene.lights[k].direction.xyz);
        if cosine > 0.0 {
            let at = place_in_map(k, point, normal, cosine);
            var seen = 1.0;
            if all(at.xy > vec2<f32>(0.0)) && all(at.xy < vec2<f32>(1.0)) {
                seen = seen_past(k, at, vec2<f32>(0.0), 0.0);
            }
            sum += scene.lights[k].radiance.rgb * (cosine * seen);
        }
    }
    return sum;
}

// The light of the sky where pixels are reduced four at a time: each takes a quarter of the lights, and has time
// to look around in their maps.
fn soft_sky(point: vec3<f32>, normal: vec3<f32>, phase: u32) -> vec3<f32> {
    let side = f32(textureDimensions(shadows).x);
    let first = (scene.counts.z & 0xffu) + phase;
    var before = 0.0;
    var stopped = 0.0;
    var height = 0.0;
    var sum = vec3<f32>(0.0);
    for (var k = first; k < scene.counts.x; k += 4u) {
        let cosine = dot(normal, scene.lights[k].direction.xyz);
        if cosine > 0.0 {
            let way = caster(k, place_in_map(k, point, normal, cosine));
            before += 1.0;
            stopped += f32(way > 0.0);
            height += way * cosine;
            sum += scene.lights[k].radiance.rgb * (4.0 * cosine);
        }
    }
    if stopped == 0.0 || stopped == before {
        return select(sum, vec3<f32>(0.0), stopped > 0.0);
    }
    height /= stopped;
    sum = vec3<f32>(0.0);
    for (var k = first; k < scene.counts.x; k += 4u) {
        let cosine = dot(normal, scene.lights[k].direction.xyz);
        if cosine > 0.0 {
            let at = place_in_map(k, point, normal, cosine);
            let way = min(height / cosine, FARTHEST);
            let own = caster(k, at);
            var seen = f32(own == 0.0);
            // What lies much nearer casts its own edge.
            if own == 0.0 || own >= 0.5 * way {
                let radius = max(scene.lights[k].part.z, 0.75 / (side * max(way, 1e-6)));
                for (var tap = 0u; tap < 3u; tap++) {
                    seen += seen_past(k, at, radius * scene.disc[(5u * tap + 4u * phase + 3u * k) % 16u].xy, way);
                }
                seen /= 4.0;
            }
            sum += scene.lights[k].radiance.rgb * (4.0 * cosine * seen);
        }
    }
    return sum;
}

// Each small light stands for a part of the key light or of the sky. Its shadow map tells what blocks its
// middle. Alone it would cast a hard edge, and the edges of all lights bands, the wider the farther the caster.
// So in penumbras the rest of its part is looked up in the same map, at the distance that casters have in the
// mean (percentage-closer soft shadows; Fernando 2005).
fn received(point: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> Received {
    let side = f32(textureDimensions(shadows).x);
    // Pixels of a square of four look up other points, which reduction or the eye averages.
    let phase = u32(pixel.x) % 2u + 2u * (u32(pixel.y) % 2u);
    let keys = scene.counts.z & 0xffu;
    var sum = vec3<f32>(0.0);

    // The key light: how many of its lights the point faces and what blocks how many of them, at which height
    // above the plane through the point.
    var key_direction = vec3<f32>(0.0);
    var before = 0.0;
    var stopped = 0.0;
    var height = 0.0;
    for (var k = 0u; k < keys; k++) {
        let direction = scene.lights[k].direction.xyz;
        let cosine = dot(normal, direction);
        key_direction += direction;
        if cosine > 0.0 {
            let way = caster(k, place_in_map(k, point, normal, cosine));
            before += 1.0;
            stopped += f32(way > 0.0);
            height += way * cosine;
            sum += scene.lights[k].radiance.rgb * cosine;
        }
    }
    var key_seen = before - stopped;
    if stopped == before {
        sum = vec3<f32>(0.0);
    } else if stopped > 0.0 {
        sum = vec3<f32>(0.0);
        key_seen = 0.0;
        height /= stopped;
        let taps = scene.counts.z >> 8u;
        for (var k = 0u; k < keys; k++) {
            let cosine = dot(normal, scene.lights[k].direction.xyz);
            if cosine <= 0.0 {
                continue;
            }
            let at = place_in_map(k, point, normal, cosine);
            let way = min(height / cosine, FARTHEST);
            let own = caster(k, at);
            // What lies much nearer casts its own edge.
            if own > 0.0 && own < 0.5 * way {
                continue;
            }
            let radius = max(scene.lights[k].part.z, 0.75 / (side * max(way, 1e-6)));
            var seen = 0.0;
            for (var tap = 0u; tap < taps; tap++) {
                let offset =
                    scene.lights[k].part.xy + radius * scene.disc[(4u * tap + phase + 3u * k) % 16u].xy;
                seen += seen_past(k, at, offset, way);
            }
            seen /= f32(taps);
            sum += scene.lights[k].radiance.rgb * (cosine * seen);
            key_seen += seen;
        }
    }
    if scene.counts.w == 0u {
        sum += hard_sky(point, normal);
    } else {
        sum += soft_sky(point, normal, phase);
    }
    return Received(sum, key_seen / max(f32(keys), 1.0), normalize(key_direction + vec3<f32>(0.0, 0.0, 1e-6)));
}

// Light that a surface of this color sends to the eye.
fn shade(color: vec3<f32>, point: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> vec3<f32> {
    let light = received(point, normal, pixel);
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
    return vec4<f32>(shade(colored(in.value, own), in.point, normal, in.position.xy), 1.0);
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
    return BallPixel(vec4<f32>(shade(in.color.rgb, hit.xyz, normal, in.position.xy), coverage), clip.z / clip.w);
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
    let light = received(in.point, normalize(in.normal), in.position.xy).diffuse;
    let share = (light + AMBIENT) / (scene.open_sky.rgb + AMBIENT);
    let distance = length(in.point - scene.bound.xyz) / scene.bound.w;
    let fade = 1.0 - smoothstep(2.5, 6.0, distance);
    return vec4<f32>(backdrop(in.position.y) * mix(vec3<f32>(1.0), min(share, vec3<f32>(1.0)), fade), 1.0);
}
