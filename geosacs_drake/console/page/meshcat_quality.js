// In Meshcat's frame, before all else there: how much of the picture is worth its time.
const quality = (() => {
  "use strict";
  // Without a graphics card a picture of full quality takes a second: what matters least goes first, until pictures
  // keep up with the robot; where they have been quick for a while, it comes back.
  const LEVELS = [
    { ratio: 1, shadows: true }, { ratio: 1, shadows: false, plain: true }, { ratio: 0.75, shadows: false, plain: true },
    { ratio: 0.55, shadows: false, plain: true }, { ratio: 0.4, shadows: false, plain: true },
  ];
  const SLOW_MS = 200, QUICK_MS = 45, QUICK_PICTURES = 300;
  const quality = {
    level: 0, best: 0, shown: -1, slow: 0, quick: 0,
    took(ms) {
      if (document.hidden) return;
      this.slow = ms > SLOW_MS ? this.slow + 1 : 0;
      this.quick = ms < QUICK_MS ? this.quick + 1 : 0;
      if (this.slow >= 2 && this.level < LEVELS.length - 1) this.set(this.level + 1);
      if (this.quick > QUICK_PICTURES && this.level > this.best) this.set(this.level - 1);
    },
    set(level) {
      this.level = level;
      this.slow = this.quick = 0;
    },
    prepare() {
      const { ratio, shadows, plain } = LEVELS[this.level], viewer = window.viewer;
      if (!viewer?.renderer) return;
      if (plain) viewer.scene.traverse(simplify);
      if (this.shown === this.level) return;
      this.shown = this.level;
      viewer.renderer.shadowMap.enabled = shadows;
      viewer.scene.traverse((part) => {
        if (part.isLight) part.castShadow &&= shadows;
        if (part.material) part.material.needsUpdate = true;
      });
      viewer.renderer.setPixelRatio(ratio * Math.min(window.devicePixelRatio, 1.5));
      viewer.set_dirty();
    },
  };
  function simplify(part) {
    const old = part.material;
    if (!old || !(old.isMeshPhongMaterial || old.isMeshStandardMaterial)) return;
    part.material = new MeshCat.THREE.MeshLambertMaterial({
      color: old.color, map: old.map, emissive: old.emissive, transparent: old.transparent, opacity: old.opacity,
      side: old.side, depthWrite: old.depthWrite, vertexColors: old.vertexColors, flatShading: old.flatShading,
    });
  }
  // Smooth edges cost four pictures there, and cannot be given up later.
  const probe = document.createElement("canvas").getContext("webgl");
  const about = probe?.getExtension("WEBGL_debug_renderer_info");
  if (about && /swiftshader|llvmpipe|software|basic render/i.test(probe.getParameter(about.UNMASKED_RENDERER_WEBGL))) {
    quality.level = 2;
    quality.best = 1;
    const getContext = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
      return getContext.call(this, kind, kind.startsWith("webgl") ? { ...options, antialias: false } : options);
    };
  }
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return quality;
})();
