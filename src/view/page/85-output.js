// What leaves the page: the view as text for the clipboard, and files.

{
  const { element, notices } = alhazen;

  alhazen.Output = class {
    #app;

    constructor(app) {
      this.#app = app;
    }

    command() {
      if (!this.#app.scene || !this.#app.camera.camera) return "";
      const header = this.#app.picture.image?.header,
        { exposure, toneMap } = this.#app.picture.settings;
      return alhazen.cameraText.command(this.#app.scene, {
        camera: this.#app.camera.camera,
        size: header ? [header.full_width, header.full_height] : this.#app.scene.size,
        samples: this.#app.scene.samples,
        light: this.#app.light,
        time: this.#app.time,
        exposure,
        toneMap,
      });
    }

    copyCommand() {
      alhazen.copyText(this.command(), "a command that renders this view");
    }

    copyPbrt() {
      if (this.#app.camera.camera)
        alhazen.copyText(alhazen.cameraText.pbrt(this.#app.scene, this.#app.camera.camera), "LookAt and Camera");
    }

    #fileName(ending) {
      const base = (this.#app.scene?.name ?? "view").replace(/^.*\//, "").replace(/\.[^.]*$/, "") || "view";
      const { layer } = this.#app.picture.settings;
      return `${base}${layer === "color" || ending === "exr" ? "" : `-${layer}`}.${ending}`;
    }

    #offer(blob, name) {
      const link = element("a", { href: URL.createObjectURL(blob), download: name });
      document.body.append(link);
      link.click();
      link.remove();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    }

    /// What is shown, at full resolution: by the program, with its metadata, where it can make that, else by the page.
    async savePng() {
      const { layer, channel, falseColour, exposure, toneMap } = this.#app.picture.settings;
      let blob = null;
      if (layer === "color" && channel === "rgb" && !falseColour) {
        const answer = await fetch(`save.png?exposure=${exposure}&tone_map=${toneMap}`).catch(() => null);
        if (answer?.ok) blob = await answer.blob();
      }
      blob ??= await this.#app.picture.png();
      if (!blob) return notices.say("There is no picture yet.");
      this.#offer(blob, this.#fileName("png"));
    }

    async saveExr() {
      const answer = await fetch("save.exr").catch(() => null);
      if (!answer?.ok) {
        const reason = answer ? (await answer.text()).trim() : "There is no connection to the program.";
        return notices.say(reason || "The image cannot be saved.", { isError: true, seconds: 8 });
      }
      this.#offer(await answer.blob(), this.#fileName("exr"));
    }
  };
}
