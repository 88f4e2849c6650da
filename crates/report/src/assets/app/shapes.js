// Bodies as things that three.js draws: surfaces, tubes along strands, spheres for particles.

const L = Libraries;

/** A material that tells the back of a sheet from its front. */
function surfaceMaterial(twoSided) {
    const material = new L.MeshStandardMaterial({ vertexColors: true, side: L.DoubleSide, roughness: 0.78, metalness: 0 });
    material.userData.back = { value: twoSided ? 0.45 : 0 };
    material.onBeforeCompile = (shader) => {
        shader.uniforms.uBack = material.userData.back;
        shader.fragmentShader = shader.fragmentShader
            .replace("#include <common>", "#include <common>\nuniform float uBack;")
            .replace(
                "#include <color_fragment>",
                `#include <color_fragment>
                if (!gl_FrontFacing) {
                    float gray = dot(diffuseColor.rgb, vec3(0.2126, 0.7152, 0.0722));
                    diffuseColor.rgb = mix(diffuseColor.rgb, vec3(gray) * vec3(1.25, 1.1, 0.95) + 0.05, uBack);
                }`,
            );
    };
    return material;
}

/** A body's surface, strands and particles, and how they follow a frame. */
class Shape {
    constructor(body, group) {
        this.body = body;
        this.positions = new Float32Array(3 * body.vertices);
        this.colors = new Float32Array(3 * body.vertices);
        this.parts = [];
        if (body.triangles.length > 0) this.addSurface(group);
        if (body.strands.length > 0) this.addTubes(group);
        if (body.particles.length > 0) this.addSpheres(group);
    }

    addSurface(group) {
        const geometry = new L.BufferGeometry();
        const position = new L.BufferAttribute(this.positions, 3).setUsage(L.DynamicDrawUsage);
        const color = new L.BufferAttribute(this.colors, 3).setUsage(L.DynamicDrawUsage);
        geometry.setAttribute("position", position).setAttribute("color", color);
        // Without normals when first drawn it would be shaded flat for good.
        geometry.setAttribute("normal", new L.BufferAttribute(new Float32Array(this.positions.length), 3).setUsage(L.DynamicDrawUsage));
        geometry.setIndex(new L.BufferAttribute(this.body.triangles, 1));
        this.material = surfaceMaterial(!this.body.obstacle);
        this.surface = new L.Mesh(geometry, this.material);
        this.wire = null;
        this.add(group, this.surface);
    }

    /** A cylinder an edge, with few sides where there are many edges. */
    addTubes(group) {
        const count = this.body.strands.length / 2;
        const sides = count > 30000 ? 4 : count > 5000 ? 5 : 8;
        // Along z from 0 to 1, radius 1, open.
        const geometry = new L.CylinderGeometry(1, 1, 1, sides, 1, true).rotateX(Math.PI / 2).translate(0, 0, 0.5);
        this.tubes = this.instanced(geometry, count);
        this.add(group, this.tubes);
    }

    addSpheres(group) {
        const count = this.body.particles.length;
        const geometry = count > 15000 ? new L.OctahedronGeometry(1, 1) : new L.IcosahedronGeometry(1, count > 3000 ? 1 : 2);
        // Normals of the sphere, not of its facets.
        geometry.setAttribute("normal", geometry.getAttribute("position").clone());
        this.spheres = this.instanced(geometry, count);
        this.add(group, this.spheres);
    }

    instanced(geometry, count) {
        const material = new L.MeshStandardMaterial({ roughness: 0.7, metalness: 0 });
        const mesh = new L.InstancedMesh(geometry, material, count);
        mesh.instanceColor = new L.InstancedBufferAttribute(new Float32Array(3 * count), 3);
        mesh.instanceMatrix.setUsage(L.DynamicDrawUsage);
        // Until the first frame arrives: spheres of a meter, all in one place, would keep a GPU busy for long.
        mesh.instanceMatrix.array.fill(0);
        return mesh;
    }

    add(group, mesh) {
        mesh.castShadow = true;
        mesh.receiveShadow = true;
        // Boxes are those of the first frame; everything is in view most of the time.
        mesh.frustumCulled = false;
        mesh.userData.shape = this;
        group.add(mesh);
        this.parts.push(mesh);
    }

    set visible(visible) {
        for (const part of this.parts) part.visible = visible;
    }

    /** Takes quantized positions; `radius` is that of strands and particles [m]. */
    move(quantized, radius) {
        dequantize(this.body, quantized, this.positions);
        if (this.surface) {
            const { geometry } = this.surface;
            geometry.getAttribute("position").needsUpdate = true;
            geometry.computeVertexNormals();
        }
        if (this.tubes) this.moveTubes(radius);
        if (this.spheres) this.moveSpheres(radius);
    }

    moveTubes(radius) {
        const { strands } = this.body;
        const { positions: p } = this;
        const m = this.tubes.instanceMatrix.array;
        for (let e = 0; e < strands.length / 2; e++) {
            const i = 3 * strands[2 * e];
            const j = 3 * strands[2 * e + 1];
            const d = [p[j] - p[i], p[j + 1] - p[i + 1], p[j + 2] - p[i + 2]];
            const length = Math.hypot(...d) || 1e-12;
            // Two directions across: d x axis, and its product with d.
            const flat = Math.abs(d[2]) < 0.9 * length;
            const u = flat ? [d[1], -d[0], 0] : [0, d[2], -d[1]];
            const su = radius / (Math.hypot(...u) || 1e-12);
            const [ux, uy, uz] = [u[0] * su, u[1] * su, u[2] * su];
            const vx = (d[1] * uz - d[2] * uy) / length;
            const vy = (d[2] * ux - d[0] * uz) / length;
            const vz = (d[0] * uy - d[1] * ux) / length;
            m.set([ux, uy, uz, 0, vx, vy, vz, 0, d[0], d[1], d[2], 0, p[i], p[i + 1], p[i + 2], 1], 16 * e);
        }
        this.tubes.instanceMatrix.needsUpdate = true;
    }

    moveSpheres(radius) {
        const { particles } = this.body;
        const m = this.spheres.instanceMatrix.array;
        for (let k = 0; k < particles.length; k++) {
            const i = 3 * particles[k];
            m[16 * k] = m[16 * k + 5] = m[16 * k + 10] = radius;
            m[16 * k + 12] = this.positions[i];
            m[16 * k + 13] = this.positions[i + 1];
            m[16 * k + 14] = this.positions[i + 2];
            m[16 * k + 15] = 1;
        }
        this.spheres.instanceMatrix.needsUpdate = true;
    }

    /** One color, told front from back. */
    paintBody(text) {
        const { r, g, b } = new L.Color(text);
        for (let k = 0; k < this.colors.length; k += 3) this.colors.set([r, g, b], k);
        this.painted(!this.body.obstacle);
    }

    /** Values as colors, the same on both sides. */
    paintValues(values, [low, high], table) {
        paint(values, low, high, table, this.colors);
        this.painted(false);
    }

    painted(twoSided) {
        if (this.surface) {
            this.surface.geometry.getAttribute("color").needsUpdate = true;
            this.material.userData.back.value = twoSided ? 0.45 : 0;
        }
        const copy = (mesh, vertexOf) => {
            const colors = mesh.instanceColor.array;
            for (let k = 0; k < mesh.count; k++) {
                const i = 3 * vertexOf(k);
                colors[3 * k] = this.colors[i];
                colors[3 * k + 1] = this.colors[i + 1];
                colors[3 * k + 2] = this.colors[i + 2];
            }
            mesh.instanceColor.needsUpdate = true;
        };
        if (this.tubes) copy(this.tubes, (k) => this.body.strands[2 * k]);
        if (this.spheres) copy(this.spheres, (k) => this.body.particles[k]);
    }

    /** Shows or hides the edges of the surface. */
    showWire(shown, color, group) {
        if (!this.surface) return;
        if (shown && !this.wire) {
            const geometry = new L.BufferGeometry();
            geometry.setAttribute("position", this.surface.geometry.getAttribute("position"));
            geometry.setIndex(new L.BufferAttribute(edgesOf({ ...this.body, strands: [] }), 1));
            this.wire = new L.LineSegments(geometry, new L.LineBasicMaterial({ transparent: true, opacity: 0.45 }));
            this.wire.frustumCulled = false;
            group.add(this.wire);
            this.parts.push(this.wire);
            this.wire.visible = this.surface.visible;
            // The lines lie on the surface: the surface steps back for them.
            Object.assign(this.material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
        }
        if (this.wire) {
            this.wire.material.color.set(color);
            this.wire.visible = shown && this.surface.visible;
        }
    }
}
