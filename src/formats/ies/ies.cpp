#include "formats/ies/ies.h"

#include <algorithm>
#include <cmath>

#include "base/file.h"
#include "formats/mesh/parse_failure.h"

namespace steradian {
namespace {

constexpr uint64_t kMaxFileBytes = uint64_t{16} << 20;
constexpr uint32_t kMaxAngles = 10'000, kMaxValues = 1'000'000, kMaxTiltPairs = 1'000;
constexpr double kMaxNumber = 1e12;

/// The numbers that follow the line with TILT=, which may be divided into lines in any way.
class IesReader {
public:
    explicit IesReader(std::string_view text) : text_(text) {}

    IntensityProfile read() {
        refuse_foreign_encoding(text_);
        const double tilt = read_tilt();
        number("the number of lamps");
        number("the lumens per lamp");
        const double multiplier = factor("the candela multiplier");
        const uint32_t verticals = count("the number of vertical angles", 2, kMaxAngles);
        const uint32_t horizontals = count("the number of horizontal angles", 1, kMaxAngles);
        if (uint64_t(verticals) * horizontals > kMaxValues)
            fail("too many candela values: at most " + std::to_string(kMaxValues), {}, ErrorCode::resources);
        expect_type_c();
        count("the type of units", 1, 2);
        for (const char* what : {"the width", "the length", "the height"}) number(what);
        const double ballast = factor("the ballast factor");
        // Since 1995 reserved and 1, since 2019 a code for where the file comes from: 1 and a little.
        double lamp = factor("the ballast-lamp photometric factor");
        if (text_.starts_with("IES:LM-63-")) lamp = 1;
        number("the input watts");

        IntensityProfile out;
        out.vertical = angles("a vertical angle", verticals, 180);
        const std::vector<float> planes = angles("a horizontal angle", horizontals, 360);
        const std::vector<Plane> order = all_around(planes);
        std::vector<float> values(size_t(verticals) * horizontals);
        for (float& value : values) {
            const double candela = number("a candela value");
            if (candela < 0) fail("a candela value must not be negative");
            value = static_cast<float>(candela * multiplier * ballast * lamp * tilt);
            if (!std::isfinite(value)) fail("this candela value is too large with its factors");
        }
        expect_end();
        for (const Plane& plane : order) {
            out.horizontal.push_back(plane.angle);
            const auto row = values.begin() + std::ptrdiff_t(plane.row) * verticals;
            out.candela.insert(out.candela.end(), row, row + verticals);
        }
        return out;
    }

private:
    /// One horizontal angle and the plane of the file that has its values.
    struct Plane {
        float angle = 0;
        size_t row = 0;
    };

    [[noreturn]] void fail(std::string message, std::string hint = {}, ErrorCode code = ErrorCode::bad_input) const {
        throw ParseFailure{word_, std::move(message), std::move(hint), code};
    }

    std::string_view next_line() {
        word_ = at_;
        const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
        const std::string_view line = text_.substr(at_, end - at_);
        at_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : end < text_.size() ? 1 : 0);
        return line;
    }

    /// Skips to the line that says how the lamp's tilt changes the values; the factor for none.
    double read_tilt() {
        constexpr std::string_view kTilt = "TILT=";
        while (at_ < text_.size()) {
            std::string_view line = next_line();
            if (!line.starts_with(kTilt)) continue;
            line.remove_prefix(kTilt.size());
            line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
            line = line.substr(0, line.find_last_not_of(" \t") + 1);
            if (line == "NONE") return 1;
            if (line == "INCLUDE") return included_tilt();
            fail("TILT=" + quoted(line) + " is not supported, expected NONE or INCLUDE",
                 "put the contents of that file in the place of its name, under TILT=INCLUDE");
        }
        word_ = text_.size();
        fail("there is no line with TILT=", "is this a photometric file (IES LM-63)?");
    }

    /// Orientation of the lamp, then pairs of angles and factors. A light has no tilt of its own in a scene, so it is
    /// the factor for 0 degrees, interpolated where it is between two.
    double included_tilt() {
        count("the orientation of the lamp", 1, 3);
        const uint32_t pairs = count("the number of tilt angles", 1, kMaxTiltPairs);
        std::vector<double> at(pairs), factors(pairs);
        for (uint32_t i = 0; i < pairs; ++i) {
            at[i] = number("a tilt angle");
            if (i > 0 && !(at[i] > at[i - 1])) fail("tilt angles must increase");
        }
        for (double& f : factors) f = factor("a tilt factor");
        const auto above = static_cast<size_t>(std::upper_bound(at.begin(), at.end(), 0.0) - at.begin());
        if (above == 0) return factors.front();
        if (above == pairs) return factors.back();
        const double t = -at[above - 1] / (at[above] - at[above - 1]);
        return factors[above - 1] + (factors[above] - factors[above - 1]) * t;
    }

    std::string_view next_word() {
        constexpr std::string_view kBetween = " \t\r\n,\v\f";
        at_ = std::min(text_.find_first_not_of(kBetween, at_), text_.size());
        word_ = at_;
        at_ = std::min(text_.find_first_of(kBetween, at_), text_.size());
        return text_.substr(word_, at_ - word_);
    }

    double number(const char* what) {
        const std::string_view word = next_word();
        if (word.empty()) fail(std::string("the file ends before ") + what);
        const std::optional<double> value = parse_double(word);
        if (!value || !(std::fabs(*value) <= kMaxNumber))
            fail(std::string("expected ") + what + " (a number), got " + quoted(word));
        return *value;
    }

    double factor(const char* what) {
        const double value = number(what);
        if (value < 0) fail(std::string(what) + " must not be negative");
        return value;
    }

    uint32_t count(const char* what, uint32_t least, uint32_t most) {
        const double value = number(what);
        if (!(value >= least && value <= most) || value != std::floor(value))
            fail(std::string("expected ") + what + ", a whole number from " + std::to_string(least) + " to " +
                 std::to_string(most) + ", got " + quoted(text_.substr(word_, at_ - word_)));
        return static_cast<uint32_t>(value);
    }

    void expect_type_c() {
        const uint32_t type = count("the photometric type", 1, 3);
        if (type != 1)
            fail(std::string("photometric type ") + (type == 2 ? "B (2)" : "A (3)") +
                     " is not supported, expected C (1)",
                 "convert the file to type C");
    }

    std::vector<float> angles(const char* what, uint32_t n, double most) {
        std::vector<float> out;
        for (uint32_t i = 0; i < n; ++i) {
            const double angle = number(what);
            if (!(angle >= 0 && angle <= most))
                fail(std::string(what) + " must be from 0 to " + std::to_string(int(most)) + " degrees");
            if (i > 0 && !(static_cast<float>(angle) > out.back())) fail(std::string("angles must increase: ") + what);
            out.push_back(static_cast<float>(angle));
        }
        return out;
    }

    /// What lies beyond `axis` is the mirror image of what lies before it.
    static void mirror(std::vector<Plane>& planes, float axis) {
        for (size_t i = planes.size(); i-- > 0;)
            if (planes[i].angle < axis) planes.push_back({2 * axis - planes[i].angle, planes[i].row});
    }

    /// The planes from 0 to 360 degrees, both included; one where they are all alike.
    std::vector<Plane> all_around(const std::vector<float>& given) const {
        std::vector<Plane> planes;
        for (size_t i = 0; i < given.size(); ++i) planes.push_back({given[i], i});
        const float first = given.front(), last = given.back();
        if (given.size() == 1) return {{0, 0}};
        if (first == 90 && last == 270) return about_the_quarter(std::move(planes));
        if (first != 0 || (last != 90 && last < 180))
            fail("horizontal angles must go from 0 to 90, 180 or 360 degrees, or from 90 to 270");
        if (last == 90) mirror(planes, 90);
        if (last <= 180) mirror(planes, 180);
        if (planes.back().angle < 360) planes.push_back({360, planes.front().row});
        return planes;
    }

    /// Symmetric about the plane of 90 and 270 degrees.
    std::vector<Plane> about_the_quarter(std::vector<Plane> planes) const {
        mirror(planes, 270);
        planes.pop_back();  // 450 is 90
        const auto whole = std::find_if(planes.begin(), planes.end(), [](const Plane& p) { return p.angle == 360; });
        if (whole == planes.end()) fail("horizontal angles from 90 to 270 degrees must contain 180");
        std::vector<Plane> out;
        for (auto p = whole; p != planes.end(); ++p) out.push_back({p->angle - 360, p->row});
        out.insert(out.end(), planes.begin(), whole + 1);
        return out;
    }

    void expect_end() {
        const std::string_view word = next_word();
        if (!word.empty() && word[0] != '\x1a')  // DOS ends files with that
            fail("expected the end of the file after the candela values, got " + quoted(word));
    }

    std::string_view text_;
    size_t at_ = 0;    ///< where reading goes on
    size_t word_ = 0;  ///< where the last word, or line, began
};

}  // namespace

Result<IntensityProfile> parse_ies(std::string_view text, const std::string& name) {
    try {
        return IesReader(text).read();
    } catch (ParseFailure& failure) {
        return text_error(text, name, std::move(failure));
    } catch (const std::bad_alloc&) {
        return out_of_memory(name);
    }
}

Result<IntensityProfile> load_ies(const std::string& path) {
    const Result<std::string> text = read_file(path, kMaxFileBytes);
    if (!text) return text.error();
    return parse_ies(*text, path);
}

}  // namespace steradian
