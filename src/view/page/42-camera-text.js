// The camera as text: for a command line, and for a scene of pbrt.

{
  const number = (value) => alhazen.shortNumber(value, 9);
  const list = (vector, separator) => vector.map(number).join(separator);
  const quoted = (text) => (/^[\w./:@%+,=-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

  /// The options that say what is seen, in the order in which a command has them.
  const viewOptions = ({ camera, size, samples, light, time, exposure, toneMap }) => {
    const options = [["look-at", [camera.position, camera.target, camera.up].map((v) => list(v, ",")).join(",")]];
    if (camera.fov !== null) options.push(["fov", number(camera.fov)]);
    // Zero replaces the lens that the file's camera may have.
    options.push(["aperture", number(camera.aperture)]);
    if (camera.aperture > 0 && camera.focus) options.push(["focus", number(camera.focus)]);
    if (light.rotation !== 0) options.push(["environment-rotate", number(light.rotation)]);
    if (light.strength !== 1) options.push(["environment-strength", number(light.strength)]);
    if (light.light_scale !== 1) options.push(["light-scale", number(light.light_scale)]);
    if (time !== null) options.push(["time", number(time)]);
    if (size) options.push(["size", `${size[0]}x${size[1]}`]);
    if (samples > 0) options.push(["spp", number(samples)]);
    if (exposure !== 0) options.push(["exposure", number(exposure)]);
    if (toneMap !== "none") options.push(["tone-map", toneMap]);
    return options;
  };

  /// A whole command that renders what is seen: the options of the page, and those that the program was started with and
  /// that the page does not set.
  const command = (scene, view) => {
    const options = viewOptions(view);
    const kept = options.reduce((text, [name]) => text.replace(new RegExp(`(^|\\s)--${name}(=|\\s)\\S+`), ""), scene.options ?? "");
    const file = `${scene.name.replace(/^.*\//, "").replace(/\.[^.]*$/, "") || "view"}.png`;
    // Values that begin with a minus are joined to their names, so that they are not taken for options.
    const words = options.map(([name, value]) => `--${name}${value.startsWith("-") ? "=" : " "}${value}`);
    return ["alhazen render", quoted(scene.path ?? scene.name), ...words, kept.trim(), "-o", quoted(file)]
      .filter(Boolean).join(" ");
  };

  /// What places the camera in a scene of pbrt, whose camera space is left-handed: scenes of right-handed formats need
  /// the first axis mirrored.
  const pbrt = (scene, camera) => {
    const lines = scene.left_handed ? [] : ["Scale -1 1 1"];
    lines.push(`LookAt ${list(camera.position, " ")}`, `       ${list(camera.target, " ")}`, `       ${list(camera.up, " ")}`);
    const lens = camera.aperture > 0
      ? ` "float lensradius" ${number(camera.aperture)} "float focaldistance" ${number(camera.focus ?? 1e6)}` : "";
    lines.push(`Camera "perspective" "float fov" ${number(camera.fov ?? 90)}${lens}`);
    return `${lines.join("\n")}\n`;
  };

  alhazen.cameraText = { command, pbrt };
}
