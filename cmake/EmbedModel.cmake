# SPDX-License-Identifier: BSD-3-Clause
# Turns the model MODEL into the C++ file OUTPUT, as one raw string in pieces that every compiler takes.
file(READ ${MODEL} text)
string(LENGTH "${text}" length)
set(code "#include \"objects/builtin_model.h\"\n\nnamespace lidar_obstacles {\n\nstd::string builtinModel() {\n    std::string text;\n")
set(at 0)
while(at LESS length)
  string(SUBSTRING "${text}" ${at} 16000 piece)
  string(APPEND code "    text += R\"model(${piece})model\";\n")
  math(EXPR at "${at} + 16000")
endwhile()
file(WRITE ${OUTPUT} "${code}    return text;\n}\n\n}  // namespace lidar_obstacles\n")
