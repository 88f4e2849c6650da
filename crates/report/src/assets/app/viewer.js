// The picture: camera, lights, bodies, ground.

/** Whether this browser gives a picture at all. */
function hasWebGL() {
    try {
        return document.createElement("canvas").getContext("webgl2") !== null;
    } catch {
        return false;
    }
}

class Viewer {
    constructor(canvas, bodies) {
        this.canvas = canvas;
        this.bodies = bodies;
        this.renderer = new L.WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: "high-performance" });
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
        this.renderer.shadowMap.enabled = true;
        this.renderer.shadowMap.type = L.PCFShadowMap;
        this.scene = new L.Scene();
        this.camera = new L.PerspectiveCamera(32, 1, 0.01, 100);
        this.camera.up.set(0, 0, 1);
        this.controls = new Libraries.OrbitControls(this.camera, canvas);
        this.controls.addEventListener("change", () => this.draw());
        // Until someone turns the camera, the run stays fitted to the picture.
        this.fitted = "fit";
        this.controls.addEventListener("start", () => (this.fitted = null));
        this.measure();
        this.addBodies();
        this.addLights();
        this.theme();
        this.view("fit");
        new ResizeObserver(() => this.resize()).observe(canvas);
        canvas.addEventListener("dblclick", (event) => this.lookAt(event));
    }

    /** The box of what matters over the whole run: deformable bodies, and obstacles that are not much larger. */
    measure() {
        const box = (bodies) => {
            const low = [0, 1, 2].map((k) => Math.min(...bodies.map((b) => b.low[k])));
            const high = [0, 1, 2].map((k) => Math.max(...bodies.map((b) => b.high[k])));
            return { low: new L.Vector3(...low), high: new L.Vector3(...high) };
        };
        const size = ({ low, high }) => high.distanceTo(low);
        const solid = this.bodies.filter((body) => body.kind !== "half-space");
        const deformable = solid.filter((body) => !body.obstacle);
        const all = box(solid.length > 0 ? solid : this.bodies);
        const inner = deformable.length > 0 ? box(deformable) : all;
        this.box = size(all) < 2.5 * size(inner) ? all : inner;
        this.size = Math.max(size(this.box), 1e-6);
        this.center = this.box.low.clone().add(this.box.high).multiplyScalar(0.5);
    }

    addBodies() {
        this.group = new L.Group();
        this.scene.add(this.group);
        this.shapes = this.bodies.map((body) => (body.kind === "half-space" ? null : new Shape(body, this.group)));
        const cell = roundCell(this.size);
        const radius = 2.6 * this.size;
        this.grounds = this.bodies.map((body) => {
            if (body.kind !== "half-space" || !body.still) return null;
            const { foot, normal } = planeOf(body, this.center);
            return new Ground(foot, normal, radius, cell, false);
        });
        if (this.grounds.every((ground) => ground === null)) {
            const foot = this.center.clone().setZ(this.box.low.z - 0.04 * this.size);
            this.floor = new Ground(foot, new L.Vector3(0, 0, 1), radius, cell, true);
        }
        for (const ground of [...this.grounds, this.floor]) if (ground) this.scene.add(ground.mesh);
    }

    addLights() {
        this.ambient = new L.HemisphereLight(0xffffff, 0x444444, 1);
        this.key = new L.DirectionalLight(0xfff6e8, 2);
        this.fill = new L.DirectionalLight(0xdfe9ff, 0.35);
        const from = (x, y, z) => this.center.clone().add(new L.Vector3(x, y, z).multiplyScalar(this.size));
        this.key.position.copy(from(-1.05, -0.6, 1.45));
        this.fill.position.copy(from(1.5, 0.6, 0.7));
        this.key.target.position.copy(this.center);
        this.fill.target.position.copy(this.center);
        const { shadow } = this.key;
        const reach = 0.72 * this.size;
        Object.assign(shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1 * this.size, far: 4.5 * this.size });
        shadow.mapSize.set(2048, 2048);
        shadow.bias = -0.0004;
        // Smooth shading of coarse meshes: facets must not shade themselves.
        shadow.normalBias = Math.max(0.0025 * this.size, 0.35 * this.edge());
        shadow.radius = 3;
        this.key.castShadow = true;
        this.scene.add(this.ambient, this.key, this.fill, this.key.target, this.fill.target);
    }

    /** Typical length of an edge of the deformable surfaces at the start [m]. */
    edge() {
        const lengths = this.bodies.filter((body) => !body.obstacle && body.triangles.length > 0).map((body) => {
            const area = body.high.map((high, k) => high - body.low[k]).sort((a, b) => b - a);
            return Math.sqrt((2 * area[0] * area[1]) / (body.triangles.length / 3));
        });
        return Math.min(lengths.length > 0 ? Math.max(...lengths) : 0, 0.03 * this.size);
    }

    theme() {
        const dark = theme() === "dark";
        this.ambient.color.set(scenery().sky);
        this.ambient.groundColor.set(scenery().earth);
        this.ambient.intensity = dark ? 1 : 1.35;
        this.key.intensity = dark ? 2.3 : 2.05;
        for (const ground of [...this.grounds, this.floor]) ground?.theme();
        this.draw();
    }

    /** Radius of strands and particles [m]: half the contact distance, else a share of the scene; never too thin to see. */
    radius(body) {
        const known = meta.delta ? 0.5 * meta.delta : 0.004 * this.size;
        return Math.max(known, (body.particles.length > 0 ? 0.002 : 0.0008) * this.size);
    }

    move(frames, frame) {
        this.shapes.forEach((shape, index) => {
            if (shape && (shape.body.moves || !shape.placed)) {
                shape.move(frames[frame][index], this.radius(shape.body));
                shape.placed = true;
            }
        });
        this.draw();
    }

    /** Turns the camera: `fit` keeps nothing, the others look along an axis. */
    view(name) {
        this.fitted = name;
        const directions = { fit: [0.62, -1.3, 0.62], front: [0, -1, 0.12], side: [1, 0, 0.12], top: [0, -0.001, 1] };
        const direction = new L.Vector3(...(directions[name] ?? directions.fit)).normalize();
        this.controls.target.copy(this.center);
        this.camera.position.copy(this.center).addScaledVector(direction, this.distance(direction));
        this.camera.near = 0.01 * this.size;
        this.camera.far = 40 * this.size;
        this.camera.updateProjectionMatrix();
        Object.assign(this.controls, { minDistance: 0.02 * this.size, maxDistance: 20 * this.size });
        this.controls.update();
        this.draw();
    }

    /** From how far, in a direction, the corners of the box fill the picture. */
    distance(direction) {
        const forward = direction.clone().negate();
        const right = forward.clone().cross(this.camera.up).normalize();
        const up = right.clone().cross(forward);
        const tall = Math.tan((this.camera.fov * Math.PI) / 360) * 0.86;
        const wide = tall * this.camera.aspect;
        let distance = 0;
        for (let k = 0; k < 8; k++) {
            const corner = new L.Vector3(
                (k & 1 ? this.box.high : this.box.low).x, (k & 2 ? this.box.high : this.box.low).y, (k & 4 ? this.box.high : this.box.low).z,
            ).sub(this.center);
            const needed = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / tall);
            distance = Math.max(distance, needed - corner.dot(forward));
        }
        return Math.max(distance, 0.1 * this.size);
    }

    /** Orbits from now on about the point under the pointer. */
    lookAt(event) {
        const { left, top, width, height } = this.canvas.getBoundingClientRect();
        const place = new L.Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
        const ray = new L.Raycaster();
        ray.setFromCamera(place, this.camera);
        for (const mesh of this.group.children) mesh.geometry?.computeBoundingSphere();
        const [hit] = ray.intersectObjects(this.group.children.filter((mesh) => mesh.visible && mesh.isMesh));
        if (hit) {
            this.controls.target.copy(hit.point);
            this.controls.update();
        }
    }

    resize() {
        const { clientWidth: width, clientHeight: height } = this.canvas;
        if (width === 0 || height === 0) return;
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        if (this.fitted) this.view(this.fitted);
        this.render();
    }

    /** Draws once before the browser's next picture. */
    draw() {
        if (this.pending) return;
        this.pending = true;
        requestAnimationFrame(() => this.render());
    }

    render() {
        this.pending = false;
        this.renderer.render(this.scene, this.camera);
    }
}
