// The ground: half-spaces as planes that fade out, with a grid; where a run has none, a faint one below it.

/** A round number of meters near a tenth of `size`: 1, 2 or 5 times a power of ten. */
function roundCell(size) {
    const power = 10 ** Math.floor(Math.log10(size / 10));
    return power * [1, 2, 5, 10].find((factor) => factor * power >= size / 10);
}

/**
 * A plane through `point` with `normal`, fading out at `radius` [m] from there.
 */
class Ground {
    constructor(point, normal, radius, cell, faint) {
        this.uniforms = { uRadius: { value: radius }, uCell: { value: cell }, uGrid: { value: new L.Color() }, uFaint: { value: faint ? 0.55 : 1 } };
        const geometry = new L.BufferGeometry();
        const r = 1.05 * radius;
        geometry.setAttribute("position", new L.BufferAttribute(new Float32Array([-r, -r, 0, r, -r, 0, r, r, 0, -r, r, 0]), 3));
        geometry.setAttribute("normal", new L.BufferAttribute(new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]), 3));
        geometry.setIndex([0, 1, 2, 0, 2, 3]);
        this.material = new L.MeshStandardMaterial({ transparent: true, roughness: 1, metalness: 0, side: L.FrontSide, depthWrite: false });
        this.material.onBeforeCompile = (shader) => {
            Object.assign(shader.uniforms, this.uniforms);
            shader.vertexShader = shader.vertexShader
                .replace("#include <common>", "#include <common>\nvarying vec2 vPlace;")
                .replace("#include <begin_vertex>", "#include <begin_vertex>\nvPlace = position.xy;");
            shader.fragmentShader = shader.fragmentShader
                .replace("#include <common>", `#include <common>
                    varying vec2 vPlace;
                    uniform float uRadius, uCell, uFaint;
                    uniform vec3 uGrid;
                    float gridLine(vec2 place) {
                        vec2 width = fwidth(place);
                        vec2 away = abs(fract(place - 0.5) - 0.5) / max(width, vec2(1e-6));
                        // Lines closer than a few pixels would flicker.
                        float near = 1.0 - smoothstep(0.15, 0.4, max(width.x, width.y));
                        return near * (1.0 - min(min(away.x, away.y), 1.0));
                    }`)
                .replace("#include <color_fragment>", `#include <color_fragment>
                    float lines = max(0.45 * gridLine(vPlace / uCell), 0.9 * gridLine(vPlace / (5.0 * uCell)));
                    diffuseColor.rgb = mix(diffuseColor.rgb, uGrid, lines);
                    diffuseColor.a *= uFaint * (1.0 - smoothstep(0.3 * uRadius, uRadius, length(vPlace)));`);
        };
        this.mesh = new L.Mesh(geometry, this.material);
        this.mesh.receiveShadow = true;
        this.mesh.position.copy(point);
        this.mesh.lookAt(new L.Vector3().copy(point).add(normal));
        // Before what is solid: it writes no depth, and what lies below a plane hardly shows through it.
        this.mesh.renderOrder = -1;
        this.theme();
    }

    theme() {
        this.material.color.set(scenery().ground);
        this.uniforms.uGrid.value.set(scenery().grid);
    }
}

/** The plane of a half-space body, from its four corners; its foot is the point below `center`. */
function planeOf(body, center) {
    const p = new Float32Array(12);
    dequantize(body, body.still.subarray(0, 12), p);
    const corner = (k) => new L.Vector3(p[3 * k], p[3 * k + 1], p[3 * k + 2]);
    const normal = corner(1).sub(corner(0)).cross(corner(3).sub(corner(0))).normalize();
    const foot = center.clone().addScaledVector(normal, corner(0).sub(center).dot(normal));
    return { foot, normal };
}
