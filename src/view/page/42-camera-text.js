// The camera as text: for a command line, and for a scene of pbrt.

{
  const number = (value) => alhazen.shortNumber(value, 7);
  const list = (vector, separator) => vector.map(number).join(separator);
  const quoted = (text) => (/^[\w./:@%+,=-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

  /// A whole command that renders what is seen.
  const command = (scene, camera, picture) => {
    const words = ["alhazen", "render", quoted(scene.path ?? scene.name)];
    words.push("--look-at", [camera.position, camera.target, camera.up].map((v) => list(v, ",")).join(","));
    if (camera.fov !== null) words.push("--fov", number(camera.fov));
    if (camera.aperture > 0) {
      words.push("--aperture", number(camera.aperture));
      if (camera.focus) words.push("--focus", number(camera.focus));
    }
    const size = picture.image?.header;
    if (size) words.push("--size", `${size.full_width}x${size.full_height}`);
    if (picture.settings.exposure !== 0) words.push("--exposure", number(picture.settings.exposure));
    if (picture.settings.toneMap !== "none") words.push("--tone-map", picture.settings.toneMap);
    if (scene.options) words.push(scene.options);
    words.push("-o", quoted(`${scene.name.replace(/^.*\//, "").replace(/\.[^.]*$/, "")}.png`));
    return words.join(" ").replace(/--look-at (?=-)/, "--look-at=").replace(/--exposure (?=-)/, "--exposure=");
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
