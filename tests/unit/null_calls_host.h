/* Calls by which a program brings what Limner uses, for null_calls_test.c, which this is a part of. */
static const lmn_technique_desc technique_desc = {sizeof(lmn_technique_desc),
                                                  sizeof(lmn_param_desc),
                                                  NULL,
                                                  "white",
                                                  NULL,
                                                  NULL,
                                                  0,
                                                  "vec4 surface_colour(surface_point p) { return vec4(1.0); }",
                                                  NULL};
static const lmn_look_desc      look_desc = LMN_LOOK_DESC_INIT;

static void *some_alloc(size_t size, void *user)
{
    (void)user;
    return malloc(size);
}
static void *some_resize(void *block, size_t size, void *user)
{
    (void)user;
    return realloc(block, size);
}
static void some_release(void *block, void *user)
{
    (void)user;
    free(block);
}
static const lmn_allocator allocator = {sizeof(lmn_allocator), some_alloc, some_resize, some_release, NULL};

CALL(lmn_allocator_set)
{
    return lmn_allocator_set(P(0, w->desc[0]), P(1, &w->error)); /* too late */
}
CALL(lmn_sheet_encode)
{
    uint8_t   *bytes = NULL;
    size_t     size;
    lmn_status status = lmn_sheet_encode(P(0, w->sheet), P(1, ".svg"), P(2, &bytes), P(3, &size), P(4, &w->error));
    lmn_bytes_free(bytes);
    return status;
}
CALL(lmn_drawing_encode)
{
    uint8_t   *bytes = NULL;
    size_t     size;
    lmn_status status = lmn_drawing_encode(P(0, w->drawing), P(1, "png"), P(2, &bytes), P(3, &size), P(4, &w->error));
    lmn_bytes_free(bytes);
    return status;
}
CALL(lmn_drawing_write_part)
{
    const int part[4] = {0, 0, 1, 1};
    uint64_t  bytes;
    return lmn_drawing_write_part(P(0, w->drawing), P(1, part), P(2, FOLDER "/part.png"), P(3, ".png"), P(4, &bytes),
                                  P(5, &w->error));
}
CALL(lmn_bytes_free)
{
    lmn_bytes_free(NULL);
    return neutral(w->null == 0 || w->null == 1);
}
CALL(lmn_techniques_create)
{
    lmn_techniques *made = NULL;
    lmn_status      status = lmn_techniques_create(P(0, &made), P(1, &w->error));
    lmn_techniques_destroy(&made);
    return status;
}
CALL(lmn_techniques_destroy)
{
    lmn_techniques *none = NULL;
    lmn_techniques_destroy(P(0, &none));
    return neutral(!none);
}
CALL(lmn_techniques_add)
{
    lmn_techniques *made = NULL;
    lmn_techniques_create(&made, NULL);
    lmn_status status = lmn_techniques_add(P(0, made), P(1, w->desc[0]), P(2, &w->error));
    lmn_techniques_destroy(&made);
    return status;
}
CALL(lmn_techniques_at)
{
    lmn_techniques    *made = NULL;
    lmn_technique_info info;
    lmn_techniques_create(&made, NULL);
    lmn_techniques_add(made, &technique_desc, NULL);
    bool there = lmn_techniques_at(P(0, made), 0, P(1, &info));
    lmn_techniques_destroy(&made);
    return neutral(!there);
}
CALL(lmn_techniques_param_at)
{
    static const lmn_param_desc row = {.key = "deep", .type = LMN_PARAM_BOOL};
    lmn_technique_desc          desc = technique_desc;
    lmn_techniques             *made = NULL;
    lmn_param_info              info;
    desc.params = &row;
    desc.param_count = 1;
    lmn_techniques_create(&made, NULL);
    lmn_techniques_add(made, &desc, NULL);
    bool there = lmn_techniques_param_at(P(0, made), P(1, "white"), 0, P(2, &info));
    lmn_techniques_destroy(&made);
    return neutral(!there);
}
CALL(lmn_look_open)
{
    lmn_look  *made = NULL;
    lmn_status status = lmn_look_open(P(0, &made), P(1, w->desc[0]), P(2, &w->error));
    lmn_look_destroy(&made);
    return status;
}
CALL(lmn_draw_pick)
{
    lmn_pick out;
    return lmn_draw_pick(P(0, w->renderer), P(1, w->scene), P(2, w->look), P(3, w->desc[0]), 0, 0, P(4, &out),
                         P(5, &w->error));
}
CALL(lmn_drawing_texture)
{
    uint32_t name;
    return lmn_drawing_texture(P(0, w->drawing), P(1, &name), P(2, &w->error)); /* it has none */
}
CALL(lmn_drawing_map_texture)
{
    uint32_t name;
    return lmn_drawing_map_texture(P(0, w->drawing), LMN_MAP_ID, P(1, &name), P(2, &w->error));
}
CALL(lmn_drawing_read_back)
{
    return lmn_drawing_read_back(P(0, w->drawing), P(1, &w->error)); /* it is there */
}
