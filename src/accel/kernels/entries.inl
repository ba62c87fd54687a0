// What callers of the kernels call, but for coherent rays and cut-outs. Included after stream_order.inl.

void intersect(const World& world, const Ray* rays, Hit* hits, size_t count) noexcept {
    if (count == 1) {
        trace_one<Mode::closest>(world, *rays, nullptr, *hits);
        return;
    }
    trace<Mode::closest>(world, rays, nullptr, count, [&](size_t i, const Hit& hit) { hits[i] = hit; });
}
void occluded(const World& world, const Ray* rays, uint8_t* result, size_t count) noexcept {
    if (count == 1) {
        Hit hit;
        trace_one<Mode::any>(world, *rays, nullptr, hit);
        *result = hit.found();
        return;
    }
    trace_any<Mode::any>(world, rays, result, count);
}
void next_hit(const World& world, const Ray* rays, const Hit* after, Hit* hits, size_t count) noexcept {
    if (count == 1) {
        trace_one<Mode::after>(world, *rays, after, *hits);
        return;
    }
    trace<Mode::after>(world, rays, after, count, [&](size_t i, const Hit& hit) { hits[i] = hit; });
}
RayVisits visits(const World& world, const Ray& ray, uint32_t& instances) noexcept {
    RayVisits out;
    instances = 0;
    Flight f;
    if (!launch<Mode::closest>(f, world, ray, nullptr, 0)) return out;
    walk<Mode::closest>(f, world, [&](uint32_t ref) {
        if (!ChildRef::is_leaf(ref)) {
            ++out.nodes;
        } else if (ref == kLeaveInstance || ref == kEnterFar) {
            return;
        } else if (ChildRef::kind(ref) == ItemKind::block) {
            for (Blocks blocks(f.level, ref); blocks.more(); blocks.next()) ++out.items;
        } else if (ChildRef::kind(ref) == ItemKind::instance) {
            ++out.items, ++instances;  // the first one is entered; the others come again
        } else {
            out.items += ChildRef::count(ref);
        }
    });
    return out;
}
