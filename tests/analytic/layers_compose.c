/* How layers meet the page. */
#include "check.h"
#include "shot.h"

int main(int argc, char **argv)
{
    return check_main(argc, argv, "layers_compose", NULL, 0);
}
