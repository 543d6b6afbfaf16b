// Mitsuba scenes: what objects and their parameters become.

#include <cmath>

#include "support/temporary_folder.h"
#include "unit/io/mitsuba_support.h"

namespace alhazen::impl::test {
namespace {

class Mitsuba : public MitsubaTest {};

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-9) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

const Material& only_material(const ParsedMitsuba& parsed) {
  return parsed.scene.materials.at(parsed.scene.groups[0].shapes.at(0).material);
}

Vec3d constant(const ParsedMitsuba& parsed, uint32_t texture) { return parsed.scene.textures.at(texture).value; }

std::string sphere_of(const std::string& bsdf) { return "<shape type=\"sphere\">" + bsdf + "</shape>"; }

TEST_F(Mitsuba, TransformsAreAppliedFromTheTopDown) {
  const ParsedMitsuba parsed = parse_content(
      R"(<shape type="cube"><transform name="to_world"><translate x="1"/><rotate z="1" angle="90"/><scale value="2, 3, 4"/>
      </transform></shape>)");
  expect_near(parsed.scene.groups[0].shapes[0].world_from_object.start.point({1, 0, 0}), {0, 6, 0});
  const ParsedMitsuba matrix = parse_content(
      R"(<shape type="cube"><transform name="to_world"><matrix value="0 1 0 5 1 0 0 6 0 0 1 7 0 0 0 1"/></transform></shape>)");
  expect_near(matrix.scene.groups[0].shapes[0].world_from_object.start.point({1, 2, 3}), {7, 7, 10});
}

TEST_F(Mitsuba, TheCameraLooksAtItsTargetWithXToTheRight) {
  const ParsedMitsuba parsed = parse_xml_text(R"(<scene version="3.0.0"><sensor type="perspective">
    <transform name="to_world"><lookat origin="0 0 8" target="0 0 0" up="0 1 0"/></transform>
    <float name="fov" value="90"/><film type="hdrfilm"><integer name="width" value="200"/><integer name="height" value="100"/>
    <rfilter type="tent"/></film><sampler type="independent"><integer name="sample_count" value="32"/></sampler>
    </sensor></scene>)");
  const Transform& world = parsed.scene.camera.world_from_camera.start;
  expect_near(world.point({}), {0, 0, 8});
  expect_near(world.direction({0, 0, 1}), {0, 0, -1});
  expect_near(world.direction({1, 0, 0}), {1, 0, 0});
  EXPECT_NEAR(parsed.scene.camera.fov, 2 * std::atan(0.5) * 180 / 3.14159265358979, 1e-9) << "over the shorter side";
  EXPECT_EQ(parsed.scene.samples_per_pixel, 32);
  EXPECT_EQ(parsed.scene.filter.type, FilterType::triangle);
  EXPECT_EQ(parsed.scene.up.y, 1);
  ASSERT_EQ(parsed.warnings.size(), 1u);
  EXPECT_EQ(parsed.warnings[0], "s.xml: the scene has no shapes and no lights; the image will be black");
}

TEST_F(Mitsuba, FieldsOfViewAreOfTheirAxis) {
  const auto fov = [](const std::string& parameters) {
    return parse_xml_text(
               "<scene version=\"3.0.0\"><sensor type=\"perspective\">" + parameters +
               R"(<film type="hdrfilm"><integer name="width" value="100"/><integer name="height" value="200"/></film>
                          </sensor></scene>)")
        .scene.camera.fov;
  };
  EXPECT_NEAR(fov(R"(<float name="fov" value="40"/>)"), 40, 1e-9);
  EXPECT_NEAR(fov(R"(<float name="fov" value="40"/><string name="fov_axis" value="smaller"/>)"), 40, 1e-9);
  EXPECT_NEAR(fov(R"(<float name="fov" value="90"/><string name="fov_axis" value="y"/>)"),
              2 * std::atan(0.5) * 180 / 3.14159265358979, 1e-9);
  // 36 by 24 millimetres have a diagonal of 43.27; the image's diagonal is sqrt(5) of its width.
  EXPECT_NEAR(fov(""), 2 * std::atan(std::hypot(36, 24) / 100 / std::sqrt(5.0)) * 180 / 3.14159265358979, 1e-9);
}

TEST_F(Mitsuba, DepthsCountSegments) {
  EXPECT_EQ(
      parse_content(R"(<integrator type="path"><integer name="max_depth" value="6"/></integrator>)").scene.max_depth,
      5);
  EXPECT_EQ(parse_content(R"(<integrator type="direct"/>)").scene.max_depth, 1);
  EXPECT_EQ(parse_content(R"(<integrator type="path"/>)").scene.max_depth, 1'000'000);
  EXPECT_EQ(parse_content(R"(<integrator type="moment"><integrator type="path"><integer name="max_depth" value="3"/>
    </integrator></integrator>)")
                .scene.max_depth,
            2);
}

TEST_F(Mitsuba, SpectraAreThoseOfTheRgbVariants) {
  // What the RGB variant of Mitsuba's Cornell box has for this reflectance: the white of equal energy.
  const ParsedMitsuba flat = parse_content(sphere_of(R"(<bsdf type="diffuse"><spectrum name="reflectance"
    value="400:0.78, 500:0.78, 600:0.78, 700:0.78"/></bsdf>)"));
  expect_near(constant(flat, only_material(flat).reflectance), {0.936461, 0.740433, 0.705267}, 0.005);
  const ParsedMitsuba uniform =
      parse_content(sphere_of(R"(<bsdf type="diffuse"><spectrum name="reflectance" value="0.25"/></bsdf>)"));
  expect_near(constant(uniform, only_material(uniform).reflectance), {0.25, 0.25, 0.25});
  const ParsedMitsuba encoded =
      parse_content(sphere_of(R"(<bsdf type="diffuse"><srgb name="reflectance" value="#ff8000"/></bsdf>)"));
  expect_near(constant(encoded, only_material(encoded).reflectance), {1, 0.21586, 0}, 1e-5);
}

TEST_F(Mitsuba, Bsdfs) {
  const auto kind = [](const std::string& bsdf) { return only_material(parse_content(sphere_of(bsdf))).kind; };
  EXPECT_EQ(kind("<bsdf type=\"diffuse\"/>"), MaterialKind::diffuse);
  EXPECT_EQ(kind("<bsdf type=\"roughconductor\"/>"), MaterialKind::conductor);
  EXPECT_EQ(kind("<bsdf type=\"thindielectric\"/>"), MaterialKind::thin_dielectric);
  EXPECT_EQ(kind("<bsdf type=\"plastic\"/>"), MaterialKind::coated_diffuse);
  EXPECT_EQ(kind("<bsdf type=\"principled\"/>"), MaterialKind::principled);
  EXPECT_EQ(kind("<bsdf type=\"twosided\"><bsdf type=\"conductor\"/></bsdf>"), MaterialKind::conductor);
  EXPECT_EQ(
      kind(
          R"(<bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="diffuse"/><bsdf type="plastic"/></bsdf>)"),
      MaterialKind::mix);
  EXPECT_TRUE(parse_content(sphere_of("<bsdf type=\"null\"/>")).scene.groups[0].shapes.empty());
  const ParsedMitsuba glass = parse_content(sphere_of("<bsdf type=\"dielectric\"/>"));
  EXPECT_NEAR(only_material(glass).ior, 1.5046 / 1.000277, 1e-12);
  const ParsedMitsuba rough = parse_content(sphere_of(
      R"(<bsdf type="roughdielectric"><string name="distribution" value="ggx"/><float name="alpha" value="0.2"/></bsdf>)"));
  EXPECT_FALSE(only_material(rough).remap_roughness) << "alpha is that of the distribution";
  expect_near(constant(rough, only_material(rough).roughness_u), {0.2, 0.2, 0.2});
  EXPECT_TRUE(rough.warnings.empty());
  const ParsedMitsuba beckmann = parse_content(sphere_of("<bsdf type=\"roughconductor\"/>"));
  ASSERT_EQ(beckmann.warnings.size(), 1u);
  EXPECT_EQ(beckmann.warnings[0],
            "s.xml:2:22: the distribution 'beckmann' (Mitsuba's default) is not supported; 'ggx' "
            "with the same alpha is used");
}

TEST_F(Mitsuba, MasksMultiplyAndNullLeavesTheRest) {
  const ParsedMitsuba masked = parse_content(sphere_of(
      R"(<bsdf type="mask"><float name="opacity" value="0.5"/><bsdf type="mask"><float name="opacity" value="0.5"/>
      <bsdf type="diffuse"/></bsdf></bsdf>)"));
  expect_near(constant(masked, only_material(masked).alpha), {0.25, 0.25, 0.25});
  const ParsedMitsuba blended = parse_content(sphere_of(
      R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/><bsdf type="null"/><bsdf type="diffuse"/></bsdf>)"));
  expect_near(constant(blended, only_material(blended).alpha), {0.25, 0.25, 0.25});
}

TEST_F(Mitsuba, BlendsAreAsOpaqueAsTheirParts) {
  const auto blend = [](const std::string& opacity) {
    return sphere_of(R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/><bsdf type="diffuse"/>
      <bsdf type="mask">)" +
                     opacity + R"(<bsdf type="plastic"/></bsdf></bsdf>)");
  };
  const ParsedMitsuba parsed = parse_content(blend(R"(<float name="opacity" value="0.2"/>)"));
  const Material& mix = only_material(parsed);
  ASSERT_EQ(mix.kind, MaterialKind::mix);
  expect_near(constant(parsed, mix.alpha), splat(0.75 + 0.25 * 0.2), 1e-12);
  expect_near(constant(parsed, mix.amount), splat(0.25 * 0.2 / 0.8), 1e-12);
  EXPECT_TRUE(parsed.warnings.empty());
  const ParsedMitsuba textured = parse_content(blend(R"(<texture type="checkerboard" name="opacity"/>)"));
  EXPECT_EQ(textured.scene.textures.at(only_material(textured).alpha).kind, TextureKind::mix);
  ASSERT_EQ(textured.warnings.size(), 1u);
  EXPECT_EQ(textured.warnings[0].find("s.xml:2:22: the BSDFs of a 'blendbsdf' differ in their opacity"), 0u);
  const ParsedMitsuba opaque = parse_content(blend(R"(<float name="opacity" value="1"/>)"));
  EXPECT_EQ(only_material(opaque).kind, MaterialKind::mix);
  EXPECT_EQ(only_material(opaque).alpha, no_index) << constant(opaque, only_material(opaque).alpha).x;
}

TEST_F(Mitsuba, PartsThatBlendsShareAreCopiedOnce) {
  std::string content = "<bsdf type=\"diffuse\" id=\"b0\"/>";
  for (int i = 1; i < 40; ++i) {
    const std::string ref = "<ref id=\"b" + std::to_string(i - 1) + "\"/>";
    content += "<bsdf type=\"blendbsdf\" id=\"b" + std::to_string(i) + "\"><float name=\"weight\" value=\"0.5\"/>" +
               ref + ref + "</bsdf>";
  }
  content += R"(<bsdf type="bumpmap"><texture type="checkerboard"/><ref id="b39"/></bsdf>)";
  EXPECT_EQ(parse_content(content).scene.materials.size(), 80u);
}

TEST_F(Mitsuba, BumpsAreSetOnBothPartsOfABlend) {
  const ParsedMitsuba parsed = parse_content(sphere_of(
      R"(<bsdf type="bumpmap"><float name="scale" value="2"/><texture type="checkerboard" name="x"/>
      <bsdf type="blendbsdf"><float name="weight" value="0.5"/><bsdf type="diffuse"/><bsdf type="plastic"/></bsdf></bsdf>)"));
  const Material& mix = only_material(parsed);
  ASSERT_EQ(mix.kind, MaterialKind::mix);
  for (const uint32_t part : mix.mixed) EXPECT_NE(parsed.scene.materials.at(part).displacement, no_index);
}

TEST_F(Mitsuba, CheckerboardsHaveTwoChecksPerUnit) {
  const ParsedMitsuba parsed = parse_content(sphere_of(
      R"(<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"><transform name="to_uv"><scale x="5" y="3"/>
      </transform></texture></bsdf>)"));
  const Texture& texture = parsed.scene.textures.at(only_material(parsed).reflectance);
  EXPECT_EQ(texture.kind, TextureKind::checkerboard);
  EXPECT_EQ(texture.uv_scale.x, 10);
  EXPECT_EQ(texture.uv_scale.y, 6);
}

TEST_F(Mitsuba, Emitters) {
  const ParsedMitsuba parsed = parse_content(R"(
    <emitter type="point"><point name="position" x="1" y="2" z="3"/><rgb name="intensity" value="4"/></emitter>
    <emitter type="directional"><vector name="direction" x="0" y="0" z="-2"/></emitter>
    <emitter type="spot"><transform name="to_world"><lookat origin="0 5 0" target="0 0 0" up="1 0 0"/></transform>
    <float name="cutoff_angle" value="40"/></emitter>)");
  ASSERT_EQ(parsed.scene.lights.size(), 4u);
  EXPECT_EQ(parsed.scene.lights[0].kind, LightKind::point);
  expect_near(parsed.scene.lights[0].position, {1, 2, 3});
  expect_near(parsed.scene.lights[0].radiance, {4, 4, 4});
  expect_near(parsed.scene.lights[1].direction, {0, 0, -1});
  expect_near(parsed.scene.lights[2].direction, {0, -1, 0});
  EXPECT_EQ(parsed.scene.lights[2].cone_angle, 40);
  EXPECT_EQ(parsed.scene.lights[2].falloff_start, 30);
  EXPECT_EQ(parsed.scene.lights[3].kind, LightKind::constant_infinite);
}

TEST_F(Mitsuba, AnEmitterThatIsReferredToLightsItsShapeAlone) {
  const ParsedMitsuba parsed = parse_content(
      R"(<shape type="rectangle"><ref id="lamp"/></shape><emitter type="area" id="lamp"><rgb name="radiance" value="7"/></emitter>)");
  EXPECT_EQ(parsed.scene.groups[0].shapes[0].emission.value().radiance.x, 7);
  EXPECT_EQ(parsed.scene.lights.size(), 1u);
}

TEST_F(Mitsuba, GroupsAreStoredOnceAndPlacedByInstances) {
  const ParsedMitsuba parsed =
      parse_content(R"(<shape type="shapegroup" id="g"><shape type="sphere"/><shape type="cube"/></shape>
    <shape type="instance"><ref id="g"/></shape>
    <shape type="instance"><ref id="g"/><transform name="to_world"><scale x="2"/></transform></shape>)");
  ASSERT_EQ(parsed.scene.groups.size(), 2u);
  EXPECT_EQ(parsed.scene.groups[1].shapes.size(), 2u);
  EXPECT_EQ(parsed.scene.groups[1].shapes[0].type, ShapeType::mesh) << "a sphere that an instance stretches";
  EXPECT_EQ(parsed.scene.instances.size(), 2u);
  EXPECT_TRUE(parsed.scene.groups[0].shapes.empty());
}

TEST_F(Mitsuba, CylindersAreExactWhereTheyAreRound) {
  const auto type = [](const std::string& content) {
    return parse_content("<shape type=\"cylinder\">" + content + "</shape>").scene.groups[0].shapes.at(0).type;
  };
  EXPECT_EQ(type(""), ShapeType::cylinder);
  EXPECT_EQ(
      type(R"(<point name="p0" value="1 2 3"/><point name="p1" value="4 5 6"/><float name="radius" value="0.5"/>)"),
      ShapeType::cylinder);
  EXPECT_EQ(type(R"(<transform name="to_world"><scale x="2"/></transform>)"), ShapeType::mesh);
  EXPECT_EQ(type("<emitter type=\"area\"/>"), ShapeType::mesh);
}

TEST_F(Mitsuba, WarnsOfBacksOnlyWhereTheyCanBeSeen) {
  EXPECT_TRUE(parse_content(sphere_of("<bsdf type=\"diffuse\"/>")).warnings.empty());
  EXPECT_TRUE(parse_content("<shape type=\"rectangle\"><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></shape>")
                  .warnings.empty());
  const ParsedMitsuba parsed = parse_content("<shape type=\"rectangle\"/><shape type=\"disk\"/>");
  ASSERT_EQ(parsed.warnings.size(), 1u);
  EXPECT_EQ(parsed.warnings[0],
            "s.xml:2:1: the back of a surface without 'twosided' is black in Mitsuba; here both sides reflect");
}

TEST_F(Mitsuba, MeshesOfFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("common"));
  folder.write_text("common/quad.obj",
                    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  folder.write_text("part.xml", R"(<scene version="3.0.0"><path value="common"/>
    <shape type="obj"><string name="filename" value="quad.obj"/></shape>
    <shape type="obj"><string name="filename" value="quad.obj"/><boolean name="face_normals" value="true"/></shape></scene>)");
  const ParsedMitsuba parsed = parse_xml_text(with_sensor(R"(<include filename="part.xml"/>
    <shape type="obj"><string name="filename" value="quad.obj"/></shape>)"),
                                              {}, folder.path());
  ASSERT_EQ(parsed.scene.groups[0].shapes.size(), 3u);
  ASSERT_EQ(parsed.scene.meshes.size(), 2u) << "each is read once";
  EXPECT_EQ(parsed.scene.meshes[0].normals.size(), 4u) << "smooth without face_normals";
  EXPECT_TRUE(parsed.scene.meshes[1].normals.empty());
  EXPECT_EQ(parsed.scene.meshes[0].uvs[0].y, 1) << "v is flipped for OBJ";
}

/// A .serialized file of a triangle in the plane z = 0 whose normals are along x.
Bytes serialized_triangle(uint32_t flags) {
  Bytes data;
  const auto put = [&](auto value) {
    const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
    data.insert(data.end(), bytes, bytes + sizeof value);
  };
  put(flags | 1u);
  put(uint8_t{0});  // no name
  put(uint64_t{3});
  put(uint64_t{1});
  for (const float coordinate : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) put(coordinate);
  for (const float coordinate : {1.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 0.f, 0.f}) put(coordinate);
  for (const uint32_t corner : {0u, 1u, 2u}) put(corner);
  // Stored, not compressed: a zlib stream of one block.
  const auto size = static_cast<uint16_t>(data.size());
  Bytes file{0x1c, 0x04, 4, 0, 0x78, 0x01, 1};
  for (const unsigned half : {unsigned{size}, ~unsigned{size}})
    for (const unsigned shift : {0u, 8u}) file.push_back(static_cast<uint8_t>(half >> shift & 0xff));
  file.insert(file.end(), data.begin(), data.end());
  return file;
}

TEST_F(Mitsuba, SerializedMeshesAreFlatWhereTheySaySo) {
  constexpr uint32_t single = 0x1000, flat = 0x10;
  const TemporaryFolder folder;
  folder.write("smooth.serialized", serialized_triangle(single));
  folder.write("flat.serialized", serialized_triangle(single | flat));
  const auto normals = [&](const std::string& file, const std::string& more) {
    return parse_xml_text(with_sensor("<shape type=\"serialized\"><string name=\"filename\" value=\"" + file +
                                      ".serialized\"/>" + more + "</shape>"),
                          {}, folder.path())
        .scene.meshes.at(0)
        .normals.size();
  };
  EXPECT_EQ(normals("smooth", ""), 3u);
  EXPECT_EQ(normals("flat", ""), 0u);
  EXPECT_EQ(normals("flat", "<boolean name=\"face_normals\" value=\"false\"/>"), 3u) << "the scene says otherwise";
  EXPECT_EQ(normals("smooth", "<boolean name=\"face_normals\" value=\"true\"/>"), 0u);
}

TEST_F(Mitsuba, FilesAreSearchedInFurtherFolders) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("scene"));
  std::filesystem::create_directories(folder.file("more"));
  folder.write_text("more/a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  folder.write_text("more/part.xml", "<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>");
  const ParsedMitsuba parsed =
      parse_xml_text(with_sensor(R"(<shape type="obj"><string name="filename" value="C:\models\a.obj"/></shape>
                     <include filename="part.xml"/>)"),
                     {}, folder.file("scene"), {{folder.file("more")}, true});
  EXPECT_EQ(parsed.scene.groups[0].shapes.size(), 2u);
}

TEST_F(Mitsuba, DefaultsAliasesAndDefinitions) {
  const std::string text = with_sensor(R"(<default name="r" value="2"/><default name="radius" value="3"/>
    <bsdf type="plastic" id="a"/><alias id="a" as="b"/>
    <shape type="sphere"><float name="radius" value="$radius"/><point name="center" value="$r 0 $r"/><ref id="b"/></shape>)");
  const auto centre_and_radius = [&](const std::vector<std::string>& definitions) {
    const ParsedMitsuba parsed = parse_xml_text(text, definitions);
    EXPECT_EQ(only_material(parsed).kind, MaterialKind::coated_diffuse);
    const Transform& world = parsed.scene.groups[0].shapes[0].world_from_object.start;
    return Vec2d{world.point({}).x, length(world.direction({1, 0, 0}))};
  };
  EXPECT_EQ(centre_and_radius({}).x, 2);
  EXPECT_EQ(centre_and_radius({}).y, 3) << "the longest name that fits";
  EXPECT_EQ(centre_and_radius({"r=5"}).x, 5) << "a definition counts before a default";
}

TEST_F(Mitsuba, NamesOfVersion1) {
  const ParsedMitsuba parsed = parse_xml_text(R"(<scene version="0.6.0">
    <sensor type="perspective"><transform name="toWorld"><lookAt origin="0 0 3" target="0 0 0"/></transform></sensor>
    <emitter type="constant"/><integrator type="path"><integer name="maxDepth" value="4"/></integrator>
    <shape type="sphere"><bsdf type="dielectric"><float name="intIOR" value="2"/><float name="extIOR" value="1"/></bsdf></shape>
    </scene>)");
  EXPECT_EQ(parsed.scene.max_depth, 3);
  EXPECT_EQ(only_material(parsed).ior, 2);
}

}  // namespace
}  // namespace alhazen::impl::test
