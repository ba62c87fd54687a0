// What callers call where some primitives are cut-outs. Included after stream_order.inl.

void occluded_or_cut_out(const World& world, const Ray* rays, uint8_t* result, size_t count) noexcept {
    if (count == 1) {
        Hit hit;
        trace_one<Mode::opaque>(world, *rays, nullptr, hit);
        *result = occlusion(hit);
        return;
    }
    trace_any<Mode::opaque>(world, rays, result, count);
}
