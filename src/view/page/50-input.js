// Pointers, wheels and keys over the picture. In the modes "orbit" and "fly" they move the camera; in "inspect", which
// is all there is while `alhazen render` runs, they move the picture.

{
  const flyKeys = {
    KeyW: [0, 0, 1],
    KeyS: [0, 0, -1],
    KeyA: [-1, 0, 0],
    KeyD: [1, 0, 0],
    KeyQ: [0, -1, 0],
    KeyE: [0, 1, 0],
  };
  const wheelRest = 180; // milliseconds without a turn of the wheel that end a motion

  /// Emits: mode (its name), hover ([x, y] or null), pick ({ x, y, focus: boolean }).
  alhazen.Input = class extends alhazen.Events {
    mode = "orbit";
    isReadOnly = false;
    flySpeed = 1; // factor on the scene's radius in a second
    #pointers = new Map();
    #gesture = null; // what a drag does: orbit, look, pan, zoom or move (the picture)
    #lastTap = { time: 0, x: 0, y: 0 };
    #wheelTimer = 0;
    #held = new Set();
    #flying = 0;

    constructor(surface, camera, viewport) {
      super();
      Object.assign(this, { surface, camera, viewport });
      const listen = (name, action, options) => surface.addEventListener(name, action, options);
      listen("pointerdown", (event) => this.#down(event));
      listen("pointermove", (event) => this.#move(event));
      for (const name of ["pointerup", "pointercancel"]) listen(name, (event) => this.#up(event));
      listen("pointerleave", () => this.emit("hover", null));
      listen("wheel", (event) => this.#wheel(event), { passive: false });
      listen("contextmenu", (event) => event.preventDefault());
      listen("keydown", (event) => this.#keyDown(event));
      // The picture is focused by every press on it; an outline is of use to the keyboard alone.
      addEventListener("pointerdown", () => document.body.classList.remove("by-keyboard"), { capture: true });
      addEventListener("keydown", (event) => event.key === "Tab" && document.body.classList.add("by-keyboard"));
      addEventListener("keyup", (event) => this.#release(event.code));
      addEventListener("blur", () => this.#releaseAll());
      document.addEventListener("visibilitychange", () => document.hidden && this.#releaseAll());
    }

    setMode(mode) {
      this.mode = this.isReadOnly ? "inspect" : mode;
      this.#releaseAll();
      if (this.mode === "fly") this.surface.focus({ preventScroll: true });
      this.surface.dataset.mode = this.mode;
      this.emit("mode", this.mode);
    }

    #at(event) {
      const box = this.surface.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    }

    #gestureOf(event) {
      const second = event.button === 2 || event.button === 1 || event.shiftKey;
      if (this.mode === "inspect" || event.ctrlKey || event.metaKey) return "move";
      if (second) return "pan";
      return this.mode === "fly" ? "look" : "orbit";
    }

    // --- Pointers ---

    #down(event) {
      this.surface.focus({ preventScroll: true });
      this.surface.setPointerCapture(event.pointerId);
      const [x, y] = this.#at(event);
      this.#pointers.set(event.pointerId, { x, y, startX: x, startY: y, time: event.timeStamp });
      this.#gesture = this.#pointers.size === 1 ? this.#gestureOf(event) : this.mode === "inspect" ? "move" : "pinch";
    }

    #move(event) {
      const [x, y] = this.#at(event),
        pointer = this.#pointers.get(event.pointerId);
      if (event.pointerType !== "touch" || pointer) this.emit("hover", [x, y]);
      if (!pointer) return;
      const before = [...this.#pointers.values()].map((each) => [each.x, each.y]);
      const [dx, dy] = [x - pointer.x, y - pointer.y];
      const isClick = Math.hypot(x - pointer.startX, y - pointer.startY) < (event.pointerType === "touch" ? 8 : 4);
      if (isClick && !pointer.dragged) return;
      if (!pointer.dragged) {
        pointer.dragged = true;
        if (this.#gesture !== "move") this.camera.begin();
        this.surface.dataset.dragging = this.#gesture;
      }
      [pointer.x, pointer.y] = [x, y];
      const after = [...this.#pointers.values()].map((each) => [each.x, each.y]);
      if (after.length >= 2) this.#pinch(before, after);
      else this.#drag(dx, dy);
    }

    #drag(dx, dy) {
      const side = Math.min(this.viewport.pictureWidth, this.viewport.pictureHeight) * this.viewport.scale || 1;
      if (this.#gesture === "move") this.viewport.pan(dx, dy);
      if (!this.camera.camera) return;
      const turn = Math.PI / Math.max(300, this.surface.clientHeight);
      if (this.#gesture === "orbit") this.camera.orbit(1.6 * turn * dx, 1.6 * turn * dy);
      if (this.#gesture === "look") this.camera.look(turn * dx, turn * dy);
      if (this.#gesture === "pan") this.camera.pan(dx / side, dy / side);
    }

    /// Two fingers: their middle pans, their distance dollies or zooms.
    #pinch(before, after) {
      const middle = (points) => [(points[0][0] + points[1][0]) / 2, (points[0][1] + points[1][1]) / 2];
      const apart = (points) => Math.max(20, Math.hypot(points[0][0] - points[1][0], points[0][1] - points[1][1]));
      const [m, n] = [middle(before), middle(after)],
        factor = apart(after) / apart(before);
      if (this.#gesture === "move") {
        this.viewport.pan(n[0] - m[0], n[1] - m[1]);
        this.viewport.zoomTo(this.viewport.scale * factor, n);
      } else if (this.camera.camera) {
        const side = Math.min(this.viewport.pictureWidth, this.viewport.pictureHeight) * this.viewport.scale || 1;
        this.camera.pan((n[0] - m[0]) / side, (n[1] - m[1]) / side);
        this.camera.dolly(1 / factor);
      }
    }

    #up(event) {
      const pointer = this.#pointers.get(event.pointerId);
      if (!pointer) return;
      this.#pointers.delete(event.pointerId);
      if (this.#pointers.size > 0) return;
      delete this.surface.dataset.dragging;
      this.camera.end();
      if (pointer.dragged || event.type === "pointercancel" || event.button === 2) return;
      this.#click(event, pointer);
    }

    #click(event, { x, y }) {
      const near = Math.hypot(x - this.#lastTap.x, y - this.#lastTap.y) < 12;
      const isDouble = near && event.timeStamp - this.#lastTap.time < 500;
      this.#lastTap = { time: isDouble ? 0 : event.timeStamp, x, y };
      this.#pickAt([x, y], isDouble);
    }

    #pickAt(point, focus) {
      if (this.isReadOnly || !this.viewport.contains(point)) return;
      const [x, y] = this.viewport.toPicture(point).map(Math.floor);
      this.emit("pick", { x, y, focus });
    }

    #wheel(event) {
      event.preventDefault();
      const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1);
      const factor = Math.exp(-alhazen.clamp(pixels, -240, 240) * 0.0015);
      if (this.mode === "inspect" || event.ctrlKey || event.metaKey) {
        // Browsers report pinches on a touchpad as small turns with the control key.
        const steps = Math.abs(pixels) < 30 ? factor ** 5 : factor ** 1.5;
        this.viewport.zoomTo(this.viewport.scale * steps, this.#at(event));
        return;
      }
      if (!this.camera.camera) return;
      this.camera.begin();
      if (this.mode === "fly") this.flySpeed = alhazen.clamp(this.flySpeed * factor, 0.01, 20);
      else this.camera.dolly(1 / factor);
      clearTimeout(this.#wheelTimer);
      this.#wheelTimer = setTimeout(() => this.#pointers.size || this.camera.end(), wheelRest);
    }

    // --- Keys ---

    #keyDown(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (this.mode === "fly" && flyKeys[event.code]) {
        event.preventDefault();
        event.stopPropagation();
        this.#hold(event.code);
        return;
      }
      if (event.key === "Enter") {
        event.preventDefault();
        return this.#pickAt([this.viewport.width / 2, this.viewport.height / 2], event.shiftKey);
      }
      const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      const zoom = { "+": 1.15, "=": 1.15, "-": 1 / 1.15 }[event.key];
      if (!arrow && !zoom) return;
      event.preventDefault();
      event.stopPropagation();
      if (this.mode === "inspect") {
        if (arrow) this.viewport.pan(-60 * arrow[0], -60 * arrow[1]);
        else this.viewport.zoomTo(this.viewport.scale * zoom ** 2);
        return;
      }
      if (!this.camera.camera) return;
      this.camera.begin();
      if (zoom) this.camera.dolly(1 / zoom);
      else if (event.shiftKey) this.camera.pan(-0.05 * arrow[0], -0.05 * arrow[1]);
      else if (this.mode === "fly") this.camera.look(0.06 * arrow[0], 0.06 * arrow[1]);
      else this.camera.orbit(-0.08 * arrow[0], -0.08 * arrow[1]);
      clearTimeout(this.#wheelTimer);
      this.#wheelTimer = setTimeout(() => this.camera.end(), wheelRest);
    }

    #hold(code) {
      const wasEmpty = this.#held.size === 0;
      this.#held.add(code);
      if (!wasEmpty || !this.camera.camera) return;
      this.camera.begin();
      this.#flying = performance.now();
      const step = (now) => {
        if (this.#held.size === 0) return;
        const seconds = alhazen.clamp((now - this.#flying) / 1000, 0, 0.1);
        this.#flying = now;
        const sum = [...this.#held].reduce((total, key) => alhazen.vec.add(total, flyKeys[key]), [0, 0, 0]);
        this.camera.fly(alhazen.vec.scale(sum, seconds * 0.5 * this.flySpeed * this.camera.radius));
        requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    }

    #release(code) {
      if (this.#held.delete(code) && this.#held.size === 0 && this.#pointers.size === 0) this.camera.end();
    }

    #releaseAll() {
      for (const code of [...this.#held]) this.#release(code);
    }
  };
}
