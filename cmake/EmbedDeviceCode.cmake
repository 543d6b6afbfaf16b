# cmake -DINPUTS="IR;PTX" -DOUTPUT=FILE -P EmbedDeviceCode.cmake: the bytes of both files as a C++ file.

set(text "#include \"backends/optix/module/device_code.h\"\n\nnamespace alhazen::impl::optix {\n\n")
set(names optix_ir ptx)
foreach(input name IN ZIP_LISTS INPUTS names)
  file(READ ${input} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND text "static const unsigned char ${name}_bytes[] = {${bytes}};\n")
endforeach()
string(APPEND text "\nDeviceCode device_code() { return {optix_ir_bytes, ptx_bytes}; }\n\n}  // namespace alhazen::impl::optix\n")
file(WRITE ${OUTPUT} "${text}")
