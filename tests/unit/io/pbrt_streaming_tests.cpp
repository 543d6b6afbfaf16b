// Scene files are read through a window: tokens that cross its edge, and tokens longer than it.

#include <zlib.h>

#include <ctime>

#include "compile/compile_scene.h"
#include "support/temporary_folder.h"
#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {

namespace {

/// The lexer's window; the tests do not depend on its size but are only difficult around it.
constexpr size_t window = size_t{1} << 18;

Parsed read(const std::string& path) {
  Parsed parsed;
  parsed.scene = read_pbrt(path, parsed.diagnostics);
  return parsed;
}

std::string error_of_file(const std::string& path) {
  try {
    read(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// Processor time, since other programs may run too.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double seconds_of(const std::string& text) {
  const double start = processor_seconds();
  Parsed parsed = parse_world(text);
  compile_scene<float>(std::move(parsed.scene), {8, 8, 1, {}}, parsed.diagnostics);
  return processor_seconds() - start;
}

TEST(PbrtStreaming, TokensAcrossTheEdgeOfTheWindow) {
  TemporaryFolder folder;
  const std::string text =
      "WorldBegin AttributeBegin NamedMaterial \"of a name\" Shape \"sphere\" \"float radius\" [ 1.25 ]\n"
      "AttributeEnd MakeNamedMaterial \"of a name\" \"string type\" \"diffuse\" \"rgb reflectance\" [ .1 .2 .3 ]\n"
      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"normal N\" [ 0 0 1 0 0 1 0 0 1 ]\n";
  for (size_t shift = 0; shift < text.size(); ++shift) {
    // The edge falls before character `shift` of the text.
    const std::string path = folder.write_text("a.pbrt", std::string(window - shift, ' ') + text);
    const Parsed parsed = read(path);
    ASSERT_EQ(shapes(parsed).size(), 2u);
    ASSERT_EQ(shapes(parsed)[0].radius, 1.25);
    ASSERT_EQ(material_of(parsed, shapes(parsed)[0]).name, "of a name");
    ASSERT_EQ(shapes(parsed)[0].where.line, 1);
    ASSERT_EQ(shapes(parsed)[1].where.line, 3);
    ASSERT_EQ(shapes(parsed)[1].where.column, 1);
  }
}

TEST(PbrtStreaming, BlanksAndCommentsOfManyWindowsBetweenTokens) {
  TemporaryFolder folder;
  const std::string blanks(3 * window + 7, ' '), comment = " #" + std::string(3 * window + 7, 'x') + "\n";
  for (const std::string& gap : {blanks, comment, std::string(2 * window, '\n')}) {
    const std::string path =
        folder.write_text("a.pbrt", "WorldBegin" + gap + "Shape" + gap + "\"sphere\"" + gap + "\"float radius\"" + gap +
                                        "[" + gap + "0.75" + gap + "]" + gap);
    const Parsed parsed = read(path);
    ASSERT_EQ(shapes(parsed).size(), 1u);
    EXPECT_EQ(shapes(parsed)[0].radius, 0.75);
  }
}

TEST(PbrtStreaming, PlaceAndExcerptFarIntoAFile) {
  TemporaryFolder folder;
  std::string text =
      "WorldBegin\n" + std::string(2 * window, '\n') + std::string(window, ' ') + "Shape \"sphere\" Shap";
  const std::string path = folder.write_text("a.pbrt", text);
  const std::string place = "a.pbrt:" + std::to_string(2 + 2 * window) + ":" + std::to_string(window + 16) + ": ";
  const std::string error = error_of_file(path);
  EXPECT_NE(error.find(place), std::string::npos) << error;
  EXPECT_NE(error.find("Shape \"sphere\" Shap\n"), std::string::npos) << error;
  // The caret is below the word.
  const size_t excerpt = error.find("Shape \"sphere\" Shap\n"), caret = error.rfind('^');
  const size_t line = error.rfind('\n', excerpt), below = error.rfind('\n', caret);
  EXPECT_EQ(caret - below, error.find("Shap\n", excerpt) - line);
}

TEST(PbrtStreaming, WordsAndStringsWithoutEndAreRefused) {
  TemporaryFolder folder;
  for (const std::string& start :
       {std::string("WorldBegin\n"), std::string("WorldBegin\nShape \""), std::string("WorldBegin\nTranslate ")}) {
    const std::string error = error_of_file(folder.write_text("a.pbrt", start + std::string(8 * window, '1')));
    EXPECT_NE(error.find("a.pbrt:2:"), std::string::npos) << error;
    EXPECT_NE(error.find("over 1 MiB"), std::string::npos) << error;
  }
  const std::string name(window, 'n');
  const std::string text = "WorldBegin MakeNamedMaterial \"" + name +
                           "\" \"string type\" \"diffuse\" NamedMaterial \"" + name + "\" Shape \"sphere\"";
  const Parsed parsed = read(folder.write_text("b.pbrt", text));
  EXPECT_EQ(material_of(parsed, shapes(parsed)[0]).name, name);
}

TEST(PbrtStreaming, CommentOfAHundredMegabytesInASmallFile) {
  TemporaryFolder folder;
  const std::string path = folder.file("a.pbrt.gz");
  {
    gzFile file = gzopen(path.c_str(), "wb1");
    gzputs(file, "WorldBegin\n#");
    const std::string part(size_t{1} << 20, 'x');
    for (int i = 0; i < 100; ++i) gzwrite(file, part.data(), static_cast<unsigned>(part.size()));
    gzputs(file, "\nShape \"sphere\"\n");
    gzclose(file);
  }
  const double start = processor_seconds();
  EXPECT_EQ(shapes(read(path)).size(), 1u);
  EXPECT_LT(processor_seconds() - start, 10);
}

TEST(PbrtStreaming, BinaryFilesAreNamedSo) {
  TemporaryFolder folder;
  const std::string error = error_of_file(folder.write_text("a.pbrt", std::string("\x7f"
                                                                                  "ELF\x02\x01\0\0\xff\x1b[31m",
                                                                                  12)));
  EXPECT_NE(error.find("binary"), std::string::npos) << error;
  EXPECT_EQ(error.find('\x1b'), std::string::npos);
  EXPECT_EQ(error.find('\xff'), std::string::npos);
}

/// The excerpt shows one character for each, so that the caret is at the right column.
TEST(PbrtStreaming, CaretBelowCharactersThatAreReplaced) {
  const std::string error = error_of("WorldBegin\n\"\x1b[31m\xc3\xa9\xff\" Shape");
  EXPECT_NE(error.find(" 2 | \"?[31m\xc3\xa9?\" Shape\n   | ^"), std::string::npos) << error;
  const std::string later = error_of("WorldBegin\nShape \"sphere\" \"string \x1b\xc3\xa9\" 1 Nothing");
  EXPECT_EQ(later.find('\x1b'), std::string::npos) << later;
}

/// Each of these was once quadratic, or worse, in the number of names.
TEST(PbrtStreaming, ManyOfAKindTakeLinearTime) {
  constexpr int many = 100'000;
  std::string forward, backward = "MakeNamedMaterial \"0\" \"string type\" \"diffuse\"\n";
  std::string tail = "MakeNamedMaterial \"" + std::to_string(many) + "\" \"string type\" \"diffuse\"\n";
  for (int i = 0; i < many; ++i) {
    const auto mix = [](int own, int other) {
      return "MakeNamedMaterial \"" + std::to_string(own) + "\" \"string type\" \"mix\" \"string materials\" [ \"" +
             std::to_string(other) + "\" \"" + std::to_string(other) + "\" ]\n";
    };
    forward += mix(i, i + 1);
    backward += mix(i + 1, i);
  }
  EXPECT_LT(seconds_of(forward + tail + "NamedMaterial \"0\" Shape \"sphere\""), 10) << "mixes of what comes later";
  EXPECT_LT(seconds_of(backward + "NamedMaterial \"" + std::to_string(many) + "\" Shape \"sphere\""), 10)
      << "mixes of what came before";

  std::string textures = "Texture \"0\" \"spectrum\" \"constant\"\n", objects, uses, alphas;
  for (int i = 0; i < 60; ++i) {
    const std::string other = std::to_string(i);
    textures += "Texture \"" + std::to_string(i + 1) + "\" \"spectrum\" \"mix\" \"texture tex1\" \"" + other +
                "\" \"texture tex2\" \"" + other + "\"\n";
  }
  const std::string error = error_of("WorldBegin\n" + textures);
  EXPECT_NE(error.find("test.pbrt:9:1: texture \"7\" has too many"), std::string::npos)
      << "a texture used twice by each of the next: " << error;
  std::string chain = "Texture \"0\" \"spectrum\" \"constant\"\n";
  for (int i = 0; i < many; ++i)
    chain += "Texture \"" + std::to_string(i + 1) + "\" \"spectrum\" \"scale\" \"texture tex\" \"" + std::to_string(i) +
             "\"\n";
  EXPECT_NE(error_of("WorldBegin\n" + chain).find("test.pbrt:66:1"), std::string::npos);
  for (int i = 0; i < many; ++i) {
    const std::string name = "\"o" + std::to_string(i) + "\"";
    uses += "ObjectInstance " + name + "\n";
    objects += "ObjectBegin " + name + " ObjectEnd\n";
    alphas += "Texture \"a" + std::to_string(i) + "\" \"float\" \"constant\"\nShape \"sphere\" \"texture alpha\" \"a" +
              std::to_string(i) + "\"\n";
  }
  EXPECT_LT(seconds_of(uses + objects + "Shape \"sphere\""), 10) << "objects used before they are defined";
  EXPECT_LT(seconds_of(alphas), 10) << "shapes of as many alphas";
}

TEST(PbrtStreaming, MixesOfThemselvesHaveAPlace) {
  const std::string error = error_of(
      "WorldBegin\nMakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [ \"b\" \"b\" ]\n"
      "MakeNamedMaterial \"b\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"a\" ]\n");
  EXPECT_NE(error.find("test.pbrt:"), std::string::npos) << error;
  EXPECT_NE(error.find("contains itself"), std::string::npos) << error;
}

TEST(PbrtStreaming, DefaultsOfAttributeAreBounded) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 300; ++i) text += "Attribute \"shape\" \"float p" + std::to_string(i) + "\" 1\n";
  const std::string error = error_of(text);
  EXPECT_NE(error.find("test.pbrt:258:1"), std::string::npos) << error;
}

}  // namespace

}  // namespace alhazen::impl::test
