// Which rays go together as packets. A picture is mostly scanned row by row, but sixteen pixels side by side have less
// in common than a square of four by four. Included by packet.inl.

/// The order in which the rays of a batch are traced. Where their directions scan a grid, four of its rows go together,
/// column by column; what is left over at either end, and everything else, goes in the order in which it was given.
class ScanOrder {
public:
    ScanOrder(const Ray* rays, size_t count) {
        const size_t first = end_of_row(rays, count, 0);
        const size_t second = end_of_row(rays, count, first);
        if (second == count) return;
        // The first row may be the rest of one.
        width_ = second - first;
        if (width_ < kLeastWidth || first > width_ || end_of_row(rays, count, second) != second + width_) return;
        first_ = first == width_ ? 0 : first;
        end_ = first_ + (count - first_) / (kRows * width_) * (kRows * width_);
    }
    /// The index of the next ray; to be called `count` times.
    size_t next() {
        const size_t place = place_++;
        if (place < first_ || place >= end_) return place;
        const size_t index = first_ + band_ + row_ * width_ + column_;
        if (++row_ == kRows) {
            row_ = 0;
            if (++column_ == width_) column_ = 0, band_ += kRows * width_;
        }
        return index;
    }

private:
    static constexpr size_t kRows = 4, kLeastWidth = 8;

    /// The index of the ray after the row that begins at `begin`: the first whose direction is much farther from the
    /// one before than those in the row are from each other. `count` where there is none within a reasonable distance.
    static size_t end_of_row(const Ray* rays, size_t count, size_t begin) {
        constexpr size_t kGreatestWidth = 1 << 14;
        constexpr float kJump = 4;
        float step = kInfinity;
        for (size_t i = begin + 1; i < min_of(count, begin + kGreatestWidth); ++i) {
            const Vec3 move = rays[i].d - rays[i - 1].d;
            const float length = max_component(abs(move));
            // Jittered pixels differ by up to twice the mean; a few of them say how much that is.
            if (i >= begin + kLeastWidth && length > kJump * step) return i;
            step = i == begin + 1 ? length : max_of(step, length);
            if (i == begin + kLeastWidth && !(step < kInfinity)) return count;
        }
        return count;
    }

    size_t width_ = 0;
    size_t first_ = 0, end_ = 0;  ///< of what is traced in bands
    size_t place_ = 0, band_ = 0, row_ = 0, column_ = 0;
};
