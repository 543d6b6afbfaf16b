// The camera: how dragging, wheels and keys move it, what is undone, and what is sent.

{
  const { add, subtract, scale, dot, cross, length, normalize, rotate } = alhazen.vec;
  const steepest = 89.5 * (Math.PI / 180);
  const copyOf = (camera) => structuredClone(camera);

  /// With as many digits as the commands have that repeat it (42-camera-text.js), so that they render the same.
  const rounded = (camera) => {
    const round = (value) => (typeof value === "number" ? Number(value.toPrecision(9)) : value);
    return Object.fromEntries(Object.entries(camera).map(([key, value]) =>
      [key, Array.isArray(value) ? value.map(round) : round(value)]));
  };

  /// Emits: changed (the camera, from whatever cause).
  alhazen.Camera = class extends alhazen.Events {
    camera = null;
    sceneUp = [0, 1, 0];
    radius = 1;
    isLeftHanded = false;
    #undone = [];
    #done = [];
    #before = null;  // the camera before the drag under way
    #moving = false;
    #id = 0;
    #send;

    /// `send(camera, moving, id)` sends one message.
    constructor(send) {
      super();
      this.#send = alhazen.oncePerFrame(() => send(this.camera, this.#moving, ++this.#id));
    }

    setScene(scene) {
      this.sceneUp = normalize(scene.up);
      this.radius = scene.radius > 0 ? scene.radius : 1;
      this.isLeftHanded = scene.left_handed;
    }

    /// The program says where the camera is: at the start, after a reset, or because another viewer moved it.
    receive(camera) {
      if (this.#before) return;  // what is being dragged is the latest
      if (this.camera && JSON.stringify(camera) !== JSON.stringify(this.camera)) this.#remember(this.camera);
      this.camera = copyOf(camera);
      this.emit("changed", this.camera);
    }

    get forward() {
      return normalize(subtract(this.camera.target, this.camera.position));
    }

    get distance() {
      return length(subtract(this.camera.target, this.camera.position));
    }

    get right() {
      return scale(normalize(cross(this.forward, this.camera.up)), this.isLeftHanded ? -1 : 1);
    }

    get upward() {
      const side = normalize(cross(this.forward, this.camera.up));
      return cross(side, this.forward);
    }

    /// The axis to turn about: the scene's way up, unless the camera is rolled about its line of sight.
    get axis() {
      const side = normalize(cross(this.forward, this.sceneUp));
      const level = cross(side, this.forward);
      return dot(level, this.upward) > 0.9998 ? this.sceneUp : normalize(this.camera.up);
    }

    // --- Changes ---

    #remember(camera) {
      this.#done.push(copyOf(camera));
      if (this.#done.length > 200) this.#done.shift();
      this.#undone = [];
    }

    /// Begins what is one step to undo. Until it ends, pictures are coarse.
    begin() {
      if (!this.camera || this.#before) return;
      this.#before = copyOf(this.camera);
      this.#moving = true;
    }

    end() {
      if (!this.#before) return;
      const before = this.#before;
      this.#before = null;
      this.#moving = false;
      if (JSON.stringify(before) === JSON.stringify(this.camera)) return;
      this.#remember(before);
      this.#changed();
    }

    get isMoving() {
      return this.#moving;
    }

    #changed() {
      this.emit("changed", this.camera);
      this.#send();
    }

    /// Changes the camera at once, as one step to undo unless a drag is under way.
    change(camera) {
      if (!this.camera) return;
      if (!this.#before) this.#remember(this.camera);
      Object.assign(this.camera, rounded(camera));
      this.#changed();
    }

    #swap(from, to) {
      if (from.length === 0 || !this.camera) return;
      to.push(copyOf(this.camera));
      this.camera = from.pop();
      this.#changed();
    }

    undo() {
      this.#swap(this.#done, this.#undone);
    }

    redo() {
      this.#swap(this.#undone, this.#done);
    }

    get canUndo() {
      return this.#done.length > 0;
    }

    get canRedo() {
      return this.#undone.length > 0;
    }

    // --- Motions, each in the directions of the display ---

    /// The direction turned by angles to the right and upwards, but not past the axis.
    #turned(direction, right, upwards) {
      const axis = this.axis, sign = this.isLeftHanded ? 1 : -1;
      const turned = rotate(direction, axis, sign * right);
      const elevation = Math.asin(alhazen.clamp(dot(normalize(turned), axis), -1, 1));
      const side = normalize(cross(turned, axis));
      return rotate(turned, side, alhazen.clamp(elevation + upwards, -steepest, steepest) - elevation);
    }

    /// Moves about the target: what is near follows the pointer by `dx` and `dy` as angles.
    orbit(dx, dy) {
      const axis = this.axis, direction = this.#turned(scale(this.forward, this.distance), dx, -dy);
      this.change({ position: subtract(this.camera.target, direction), up: axis });
    }

    /// Looks around from where it is.
    look(dx, dy) {
      const axis = this.axis, direction = this.#turned(scale(this.forward, this.distance), dx, -dy);
      this.change({ target: add(this.camera.position, direction), up: axis });
    }

    #translate(by) {
      this.change({ position: add(this.camera.position, by), target: add(this.camera.target, by) });
    }

    /// Moves across the line of sight so that the target follows the pointer by fractions of the shorter side.
    pan(dx, dy) {
      const size = 2 * this.distance * Math.tan(((this.camera.fov ?? 45) * Math.PI) / 360);
      this.#translate(add(scale(this.right, -dx * size), scale(this.upward, dy * size)));
    }

    /// Changes the distance to the target by a factor. Close to it, the target moves on ahead.
    dolly(factor) {
      const nearest = 1e-4 * this.radius, to = this.distance * factor;
      const forward = this.forward;
      if (to < nearest) return this.#translate(scale(forward, this.distance * (1 - factor)));
      this.change({ position: subtract(this.camera.target, scale(forward, to)) });
    }

    /// Moves by a vector in the camera's own directions: right, up, forward.
    fly([x, y, z]) {
      this.#translate(add(add(scale(this.right, x), scale(this.axis, y)), scale(this.forward, z)));
    }

    /// Turns to a point, which is in focus then.
    focusOn(point) {
      this.change({ target: point, focus: length(subtract(point, this.camera.position)) });
    }
  };
}
