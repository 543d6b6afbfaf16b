// Bakes light into the vertex colours of a model: that of a sky with a large sun, and what the model itself reflects,
// by ray queries from its vertices. Writes a PLY file, reads it again, and renders its colours as they are.

#include <alhazen/rays.h>
#include <alhazen/save.h>
#include <alhazen/scene.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <random>

constexpr int bounces = 3, samples = 256;
using alhazen::Vec3;
Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 normalize(Vec3 a) { return a * (1 / std::sqrt(dot(a, a))); }
std::ostream& operator<<(std::ostream& out, Vec3 a) { return out << a.x << ' ' << a.y << ' ' << a.z; }

Vec3 sky(Vec3 d) {  // the radiance: a gradient from the ground to the zenith, and a sun with soft edges
  return Vec3{0.2, 0.28, 0.4} * (1 + d.y) + Vec3{7, 6, 4.2} * std::pow(std::max(0.0, dot(d, {0.6, 0.7, 0.39})), 20);
}

int main(int argc, char** argv) try {
  if (argc != 4) return std::fprintf(stderr, "usage: light_baking MODEL OUT.ply OUT.png\n"), 2;
  const Vec3 albedo{0.8, 0.6, 0.45};
  const alhazen::Scene model = alhazen::Scene::load(argv[1]);
  const alhazen::MeshView mesh = model.mesh(model.meshes().at(0));
  if (mesh.normals.empty()) throw std::runtime_error("the model has no vertex normals");
  const size_t vertices = mesh.normals.size() / 3, triangles = mesh.indices.size() / 3;
  std::vector<Vec3> normals(vertices), origins(vertices), directions(vertices), radiance(vertices);
  const auto vector_at = [](auto all, size_t i) { return Vec3{all[3 * i], all[3 * i + 1], all[3 * i + 2]}; };
  for (size_t i = 0; i < vertices; ++i) {
    normals[i] = normalize(vector_at(mesh.normals, i));
    origins[i] = vector_at(mesh.positions, i) + normals[i] * 1e-5;  // off the surface that it leaves
  }
  const alhazen::RayQueries queries(model, {.precision = "double"});
  const alhazen::RayArrays<double> rays{&origins[0].x, &directions[0].x, vertices};
  std::vector<double> t(vertices), weights(2 * vertices);
  std::vector<uint32_t> hit(vertices);
  const alhazen::HitArrays<double> hits{.t = t.data(), .barycentrics = weights.data(), .primitives = hit.data()};
  std::mt19937 random;
  std::uniform_real_distribution<double> uniform;
  for (int bounce = 0; bounce < bounces; ++bounce) {
    std::vector<Vec3> next(vertices);
    for (int sample = 0; sample < samples; ++sample) {
      for (size_t i = 0; i < vertices; ++i) {  // by the cosine: the normal and a point on the unit sphere
        const double z = 2 * uniform(random) - 1, phi = 6.283185307 * uniform(random), r = std::sqrt(1 - z * z);
        directions[i] = normalize(normals[i] * 1.0001 + Vec3{r * std::cos(phi), r * std::sin(phi), z});
      }
      queries.closest_hits(rays, hits);
      for (size_t i = 0; i < vertices; ++i) {
        const uint32_t* v = std::isinf(t[i]) ? nullptr : &mesh.indices[3 * size_t{hit[i]}];
        const double b = weights[2 * i], c = weights[2 * i + 1];
        const Vec3 in = v ? radiance[v[0]] * (1 - b - c) + radiance[v[1]] * b + radiance[v[2]] * c : sky(directions[i]);
        next[i] = next[i] + albedo * in * (1.0 / samples);  // albedo / pi times the irradiance, pi times the mean
      }
    }
    radiance = next;  // what the next bounce finds at its hits
  }
  std::ofstream ply(argv[2]);
  ply << "ply\nformat ascii 1.0\nelement vertex " << vertices << '\n';
  for (const char* name : {"x", "y", "z", "red", "green", "blue"}) ply << "property float " << name << '\n';
  ply << "element face " << triangles << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (size_t i = 0; i < vertices; ++i) ply << origins[i] << ' ' << radiance[i] << '\n';
  for (size_t i = 0; i < 3 * triangles; ++i) ply << (i % 3 ? " " : i ? "\n3 " : "3 ") << mesh.indices[i];
  if (ply << '\n'; !ply.flush()) throw std::runtime_error(std::string(argv[2]) + " cannot be written");
  alhazen::Scene baked = alhazen::Scene::load(argv[2]);
  alhazen::Shape shape = baked.shape(baked.shapes().at(0));
  shape.emission = alhazen::Emission{.texture = baked.add(alhazen::VertexColourTexture{})};
  baked.set(baked.shapes()[0], shape);
  alhazen::save(alhazen::render(baked, {.samples_per_pixel = 16, .max_depth = 0, .width = 480}), argv[3]);
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
