#include "app/commands.h"

int main(int argc, char** argv) {
    return reljef::cli::run_program(reljef::app::reljef_program, argc, argv);
}
