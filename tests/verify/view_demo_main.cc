// view_demo FILE: writes the demonstration page, to look at it or to load it in a browser's test.
#include <fstream>
#include <iostream>

#include "tests/verify/view_demo.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: view_demo page.html\n";
    return 2;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << cguide::verify::RenderPage(cguide::verify::DemoInput());
  file.close();
  return file ? 0 : 1;
}
