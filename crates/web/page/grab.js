// The pointer takes hold of a vertex and leads it in the plane through it that faces the camera.
"use strict";

class Grab {
    /** `tell` gets { do: "grab" | "lead" | "release", .. } for the simulation. */
    constructor(viewer, tell) {
        // The pointer that holds it: other fingers may touch the page meanwhile.
        Object.assign(this, { viewer, tell, vertex: null, pointer: null });
        this.end = new AbortController();
        const on = (target, name, action) => target.addEventListener(name, action, { signal: this.end.signal, capture: true });
        on(viewer.canvas, "pointerdown", (event) => this.take(event));
        const own = (action) => (event) => event.pointerId === this.pointer && action(event);
        on(window, "pointermove", own((event) => this.lead(event)));
        on(window, "pointerup", own(() => this.release()));
        on(window, "pointercancel", own(() => this.release()));
    }

    ray(event) {
        const { left, top, width, height } = this.viewer.canvas.getBoundingClientRect();
        const place = new L.Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
        const ray = new L.Raycaster();
        ray.setFromCamera(place, this.viewer.camera);
        return ray;
    }

    /** The vertex of a deformable body under the pointer, and where it was hit. */
    hit(ray) {
        const meshes = this.viewer.group.children.filter((mesh) => mesh.isMesh);
        for (const mesh of meshes) {
            mesh.geometry.computeBoundingSphere();
            if (mesh.isInstancedMesh) mesh.computeBoundingSphere();
        }
        const [hit] = ray.intersectObjects(meshes, false);
        const body = hit?.object.userData.shape?.body;
        if (!body || body.obstacle) return null;
        const { positions } = hit.object.userData.shape;
        const choices = hit.face ? [hit.face.a, hit.face.b, hit.face.c] : [];
        if (hit.object.isInstancedMesh) {
            const k = hit.instanceId;
            choices.splice(0, 3, ...(body.strands.length > 0 ? [body.strands[2 * k], body.strands[2 * k + 1]] : [body.particles[k]]));
        }
        const place = (v) => new L.Vector3().fromArray(positions, 3 * v);
        choices.sort((a, b) => place(a).distanceTo(hit.point) - place(b).distanceTo(hit.point));
        return { vertex: body.start + choices[0], place: place(choices[0]) };
    }

    take(event) {
        if (event.button !== 0 || !event.isPrimary || this.vertex !== null) return;
        const hit = this.hit(this.ray(event));
        if (!hit) return;
        // The camera stays while a body is pulled.
        this.viewer.controls.enabled = false;
        this.pointer = event.pointerId;
        this.vertex = hit.vertex;
        this.plane = hit.place;
        this.normal = this.viewer.camera.getWorldDirection(new L.Vector3());
        this.tell({ do: "grab", vertex: hit.vertex, speed: 4 * this.viewer.size });
    }

    lead(event) {
        const { origin, direction } = this.ray(event).ray;
        const along = this.plane.clone().sub(origin).dot(this.normal) / direction.dot(this.normal);
        if (along > 0) this.tell({ do: "lead", target: origin.clone().addScaledVector(direction, along).toArray() });
    }

    release() {
        this.vertex = null;
        this.pointer = null;
        this.viewer.controls.enabled = true;
        this.tell({ do: "release" });
    }

    /** Stops listening. */
    close() {
        this.end.abort();
    }
}
