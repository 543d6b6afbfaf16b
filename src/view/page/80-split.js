// The line between two layers that are compared, which is dragged or moved by the arrow keys.

{
  alhazen.buildSplit = (app) => {
    const { picture, viewport } = app, line = alhazen.byId("split");
    const set = (value) => picture.set({ split: alhazen.clamp(value, 0, 1) });
    line.addEventListener("pointerdown", (event) => {
      line.setPointerCapture(event.pointerId);
      line.focus();
      event.preventDefault();
    });
    line.addEventListener("pointermove", (event) => {
      if (!line.hasPointerCapture(event.pointerId)) return;
      set((event.clientX - viewport.element.getBoundingClientRect().left) / viewport.width);
    });
    line.addEventListener("keydown", (event) => {
      const to = { ArrowLeft: picture.settings.split - 0.02, ArrowDown: picture.settings.split - 0.02,
        ArrowRight: picture.settings.split + 0.02, ArrowUp: picture.settings.split + 0.02, Home: 0, End: 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      set(to);
    });
    const update = () => {
      const { settings } = picture;
      line.hidden = !(settings.other && picture.otherImage);
      line.style.left = `${settings.split * 100}%`;
      line.setAttribute("aria-valuenow", String(Math.round(100 * settings.split)));
      const name = (layer) => {
        const image = picture.imageOf(layer);
        return image ? alhazen.layerName(image.header.layer) : "";
      };
      alhazen.byId("split-left").textContent = name(settings.layer);
      alhazen.byId("split-right").textContent = settings.other ? name(settings.other) : "";
    };
    picture.on("changed", update);
    picture.on("drawn", update);
  };
}
