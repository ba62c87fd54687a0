// Writes the scenes with known pictures, the images they refer to, cases.json with what must come out of them, and the
// same as the table of docs/verification.md in cases.md:
//   analytic_scenes OUT_DIR
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>

#include "analytic/case.h"
#include "steradian/image_io.h"

namespace steradian::analytic {
namespace {

std::string json_string(const std::string& s) {
    std::string out = "\"";
    for (const char c : s) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    out += '"';
    return out;
}

std::string region(const Expected& e) {
    Object out;
    if (e.x1) {
        std::string pixels;
        for (const uint32_t edge : {e.x0, e.y0, e.x1, e.y1}) {
            pixels += pixels.empty() ? "[" : ", ";
            pixels += std::to_string(edge);
        }
        pixels += ']';
        out.raw("pixels", std::move(pixels));
    }
    return out.set("mean", e.value).set("every_pixel", e.every_pixel).str();
}

std::string entry(const Case& c) {
    Object out;
    out.set("id", std::string_view(c.id))
        .raw("formula", json_string(c.formula))
        .set("scene", std::string_view(c.id + ".json"));
    out.set("class", c.kind == CaseClass::zero_variance ? "zero_variance" : "stochastic").set("tolerance", c.tolerance);
    std::string regions;
    for (const Expected& e : c.expected) {
        regions += regions.empty() ? "[" : ", ";
        regions += region(e);
    }
    regions += ']';
    return out.raw("expected", std::move(regions)).str();
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

int write_all(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::string list = "[\n", table = "| case | value | class | from |\n| --- | --- | --- | --- |\n";
    std::set<std::string> written;
    const std::vector<Case> cases = all_cases();
    for (const Case& c : cases) {
        write_text(folder / (c.id + ".json"), c.scene);
        for (const CaseFile& file : c.files) {
            if (!written.insert(file.name).second) continue;
            if (!file.text.empty()) {
                write_text(folder / file.name, file.text);
                continue;
            }
            if (const Status status = write_image((folder / file.name).string(), file.image); !status)
                throw std::runtime_error(status.error().str());
        }
        table += table_row(c);
        table += '\n';
        list += "  ";
        list += entry(c);
        list += &c == &cases.back() ? "\n" : ",\n";
    }
    list += "]\n";
    write_text(folder / "cases.json", list);
    write_text(folder / "cases.md", table);
    std::printf("%zu scenes and cases.json in %s\n", cases.size(), folder.c_str());
    return 0;
}

}  // namespace
}  // namespace steradian::analytic

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr,
                     "usage: analytic_scenes OUT_DIR\nWrites the scenes with known pictures and cases.json with what "
                     "they must show.\n");
        return 2;
    }
    try {
        return steradian::analytic::write_all(argv[1]);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "analytic_scenes: %s\n", e.what());
        return 4;
    }
}
