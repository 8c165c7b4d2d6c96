/* Calls of limner/rules.h for null_calls_test.c, which this is a part of. */
CALL(lmn_kind_count)
{
    return neutral(!(w->null == 0 && lmn_kind_count() > 0));
}
CALL(lmn_kind_at)
{
    lmn_kind_info info;
    return neutral(!(lmn_kind_at(0, P(0, &info))));
}
CALL(lmn_technique_at)
{
    lmn_technique_info info;
    return neutral(!(lmn_technique_at(P(0, "lines"), 0, P(1, &info))));
}
CALL(lmn_motion_way_at)
{
    lmn_motion_way_info info;
    return neutral(!(lmn_motion_way_at(0, P(0, &info))));
}
CALL(lmn_look_set_motion_way)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_motion_way(P(0, look), P(1, "ghosts"), P(2, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_motion_way)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_look_set_motion_way(look, "ghosts", NULL);
    const char *way = lmn_look_motion_way(P(0, look));
    lmn_look_destroy(&look);
    return neutral(!way);
}
CALL(lmn_param_at)
{
    lmn_param_info info;
    return neutral(!(lmn_param_at(P(0, "lines"), P(1, "strokes"), 0, P(2, &info))));
}
CALL(lmn_param_find)
{
    lmn_param_info info;
    return lmn_param_find(P(0, "lines"), P(1, "strokes"), P(2, "width"), P(3, &info), P(4, &w->error));
}
CALL(lmn_look_create)
{
    lmn_look  *made = NULL;
    lmn_status status = lmn_look_create(P(0, &made), P(1, &w->error));
    lmn_look_destroy(&made);
    return status;
}
CALL(lmn_look_copy)
{
    lmn_look  *made = NULL;
    lmn_status status = lmn_look_copy(P(0, &made), P(1, w->look), P(2, &w->error));
    lmn_look_destroy(&made);
    return status;
}
CALL(lmn_look_set_name)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_name(P(0, look), P(1, "n"), P(2, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_doc)
{
    return neutral(!(lmn_look_doc(P(0, w->look))));
}
CALL(lmn_look_set_doc)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_doc(P(0, look), P(1, "d"), P(2, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_revision)
{
    return neutral(!(lmn_look_revision(P(0, w->look)) != 0));
}
CALL(lmn_look_changes)
{
    return neutral(!(lmn_look_changes(P(0, w->look), 0) != 0));
}
CALL(lmn_look_rule_count)
{
    return neutral(!(lmn_look_rule_count(P(0, w->look)) > 0));
}
CALL(lmn_look_add_rule)
{
    lmn_look *look = NULL;
    size_t    number = 0;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_add_rule(P(0, look), P(1, "*"), LMN_AT_END, P(2, &number), P(3, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_remove_rule)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_look_add_rule(look, "*", LMN_AT_END, NULL, NULL);
    lmn_status status = lmn_look_remove_rule(P(0, look), 0, P(1, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_move_rule)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_move_rule(P(0, look), 0, 0, P(1, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_rule_selector)
{
    return neutral(!(lmn_look_rule_selector(P(0, w->look), 0)));
}
CALL(lmn_look_set_rule_selector)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_rule_selector(P(0, look), 0, P(1, "*"), P(2, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_rule_name)
{
    return neutral(!(lmn_look_rule_name(P(0, w->look), 0)));
}
CALL(lmn_look_set_rule_name)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_rule_name(P(0, look), 0, P(1, "r"), P(2, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_technique_count)
{
    return neutral(!(lmn_look_technique_count(P(0, w->look), 0, P(1, "lines")) > 0));
}
CALL(lmn_look_technique)
{
    return neutral(!(lmn_look_technique(P(0, w->look), 0, P(1, "lines"), 0)));
}
CALL(lmn_look_set_technique)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_technique(P(0, look), 0, P(1, "lines"), 0, P(2, "id"), P(3, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_add_technique)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_add_technique(P(0, look), 0, P(1, "lines"), P(2, "id"), LMN_AT_END, P(3, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_remove_technique)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_remove_technique(P(0, look), 0, P(1, "lines"), 0, P(2, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_move_technique)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_move_technique(P(0, look), 0, P(1, "lines"), 0, 0, P(2, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_param_state)
{
    lmn_look       *look = NULL;
    lmn_param_state state;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status =
        lmn_look_param_state(P(0, look), 0, P(1, "lines"), 0, P(2, "width"), P(3, &state), P(4, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_get_text)
{
    lmn_look *look = NULL;
    char      text[LMN_VALUE_TEXT_MAX];
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status =
        lmn_look_get_text(P(0, look), 0, P(1, "lines"), 0, P(2, "width"), P(3, text), sizeof text, P(4, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_set_text)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_text(P(0, look), 0, P(1, "lines"), 0, P(2, "width"), P(3, "2"), P(4, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_get_number)
{
    lmn_look *look = NULL;
    double    number;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status =
        lmn_look_get_number(P(0, look), 0, P(1, "lines"), 0, P(2, "width"), P(3, &number), P(4, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_set_number)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_number(P(0, look), 0, P(1, "lines"), 0, P(2, "width"), 2, P(3, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_get_colours)
{
    lmn_look *look = NULL;
    float     rgba[4 * LMN_PALETTE_MAX];
    size_t    count;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_get_colours(P(0, look), 0, P(1, "lines"), 0, P(2, "colour"), P(3, rgba), P(4, &count),
                                             P(5, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_set_colours)
{
    lmn_look   *look = NULL;
    const float rgba[4] = {0, 0, 0, 1};
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status =
        lmn_look_set_colours(P(0, look), 0, P(1, "lines"), 0, P(2, "colour"), P(3, rgba), 1, P(4, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_get_direction)
{
    lmn_look *look = NULL;
    double    direction[3] = {0, 1, 0};
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_get_direction(P(0, look), LMN_WHOLE_LOOK, P(1, "scene"), 0, P(2, "light_direction"),
                                               P(3, direction), P(4, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_set_direction)
{
    lmn_look *look = NULL;
    double    direction[3] = {0, 1, 0};
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_direction(P(0, look), LMN_WHOLE_LOOK, P(1, "scene"), 0, P(2, "light_direction"),
                                               P(3, direction), P(4, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_set_auto)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_auto(P(0, look), 0, P(1, "lines"), 0, P(2, "inner_colour"), P(3, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_reset)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_reset(P(0, look), 0, P(1, "lines"), 0, P(2, "width"), P(3, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_control_count)
{
    return neutral(!(w->null == 0 && lmn_control_count() > 0));
}
CALL(lmn_control_at)
{
    lmn_control_info info;
    return neutral(!(lmn_control_at(0, P(0, &info))));
}
CALL(lmn_look_has_control)
{
    return neutral(!(lmn_look_has_control(P(0, w->look), P(1, "weight"))));
}
CALL(lmn_look_get_control)
{
    double value;
    return lmn_look_get_control(P(0, w->look), P(1, "weight"), P(2, &value), P(3, &w->error));
}
CALL(lmn_look_set_control)
{
    lmn_look *look = NULL;
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_control(P(0, look), P(1, "weight"), 0.5, P(2, &w->error));
    lmn_look_destroy(&look);
    return status;
}
CALL(lmn_look_control_map)
{
    lmn_control_map map;
    return neutral(!(lmn_look_control_map(P(0, w->look), P(1, "weight"), 0, P(2, &map))));
}
CALL(lmn_look_set_control_maps)
{
    lmn_look             *look = NULL;
    const lmn_control_map map = {"lines.width", true, 0.5, 2};
    lmn_look_copy(&look, w->look, NULL);
    lmn_status status = lmn_look_set_control_maps(P(0, look), P(1, "scale"), P(2, &map), 1, P(3, &w->error));
    lmn_look_destroy(&look);
    return status;
}
