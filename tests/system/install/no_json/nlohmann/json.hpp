#error "a program that uses Roio does not need nlohmann-json"
