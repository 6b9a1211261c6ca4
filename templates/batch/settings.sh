# shellcheck shell=bash
# Reads the settings of this job from job.conf and then local.conf, for the scripts beside this file.
#
# Each line sets one value: KEY=value. The value is the text up to the end of the line, without quotes around it. It is never
# executed or expanded, since names of scenes and files come from the author of the scene.

# Prints a text in one line. Control characters and characters that change the direction of writing become `?`.
plain() {
    local text=${*//[[:cntrl:]]/?}
    # The patterns are the bytes of U+061C, U+200E, U+200F, U+2028 to U+202E and U+2066 to U+2069, since the locale is C.
    text=${text//$'\xd8\x9c'/?}
    text=${text//$'\xe2\x80'[$'\x8e\x8f\xa8'-$'\xae']/?}
    text=${text//$'\xe2\x81'[$'\xa6'-$'\xa9']/?}
    printf '%s' "$text"
}

# Ends the script with an error message for line `number` of the settings `file`.
wrong_setting() {
    printf '%s: %s, line %s: %s\n' "${0##*/}" "$file" "$number" "$(plain "$1")" >&2
    exit 2
}

# Sets the variables of one file. Bash evaluates numbers as expressions, so a number must consist of digits only.
read_settings_of() {
    local file=$1 number=0 line key value
    while IFS= read -r line || [[ -n $line ]]; do
        number=$((number + 1))
        line=${line%$'\r'}
        [[ $line == *[![:space:]]* && $line != '#'* ]] || continue
        [[ $line =~ ^([A-Z_]+)=(.*)$ ]] || wrong_setting "expected KEY=value, found \`$line\`"
        key=${BASH_REMATCH[1]} value=${BASH_REMATCH[2]}
        if [[ $value == [\'\"]* ]]; then
            [[ ${#value} -ge 2 && $value == *"${value:0:1}" ]] ||
                wrong_setting "the quote at the start of the value must be closed at the end of the line"
            value=${value:1:${#value}-2}
        fi
        case $key in
            FILE) FILES+=("$value") ;;
            LAST_FRAME | DIGITS | CHUNK | LIMIT | PROCESSES)
                [[ $value =~ ^[0-9]{1,9}$ ]] || wrong_setting "$key is a number, not \`$value\`"
                printf -v "$key" '%d' "$((10#$value))"
                ;;
            END | FRAME_RATE)
                [[ $value =~ ^[0-9]+(\.[0-9]+)?$ ]] || wrong_setting "$key is a number, not \`$value\`"
                printf -v "$key" '%s' "$value"
                ;;
            FRAMES)
                [[ $value =~ ^[0-9]{1,9}(-[0-9]{1,9})?(,[0-9]{1,9}(-[0-9]{1,9})?)*$ ]] ||
                    wrong_setting "FRAMES is a list such as 7,13-24, not \`$value\`"
                printf -v "$key" '%s' "$value"
                ;;
            BLURRED | TRUST)
                [[ $value == yes || $value == no ]] || wrong_setting "$key is yes or no, not \`$value\`"
                printf -v "$key" '%s' "$value"
                ;;
            JOB | OPTIONS | POVRAY | JABUKA | FFMPEG | VIDEO_OPTIONS) printf -v "$key" '%s' "$value" ;;
            *) wrong_setting "unknown setting \`$key\`" ;;
        esac
    done <"$file"
}

FILES=()
read_settings_of job.conf
[[ ! -f local.conf ]] || read_settings_of local.conf
