/* The seven functions of `libgfortran.so.3` that LAPACK inside of some BOPTEST cases calls, for systems that have no such library:
 *
 *     cc -O2 -shared -fPIC -Wl,--version-script=gfortran3.map -Wl,-soname,libgfortran.so.3 gfortran3.c -o libgfortran.so.3
 *
 * Texts are compared and joined as in Fortran; what LAPACK would print of an error in its arguments is left out. */
int _gfortran_compare_string(int one_length, const char *one, int other_length, const char *other) {
    int length = one_length > other_length ? one_length : other_length;
    for (int i = 0; i < length; i++) {
        unsigned char a = i < one_length ? one[i] : ' ', b = i < other_length ? other[i] : ' ';
        if (a != b) return a < b ? -1 : 1;
    }
    return 0;
}
void _gfortran_concat_string(int length, char *to, int one_length, const char *one, int other_length, const char *other) {
    for (int i = 0; i < length; i++)
        to[i] = i < one_length ? one[i] : i - one_length < other_length ? other[i - one_length] : ' ';
}
int _gfortran_pow_i4_i4(int base, int power) {
    if (power < 0) return base == 1 ? 1 : base == -1 ? (power % 2 ? -1 : 1) : 0;
    int result = 1;
    for (; power > 0; power--) result *= base;
    return result;
}
void _gfortran_st_write(void *to) { (void)to; }
void _gfortran_st_write_done(void *to) { (void)to; }
void _gfortran_transfer_character_write(void *to, void *text, int length) { (void)to, (void)text, (void)length; }
void _gfortran_transfer_integer_write(void *to, void *number, int length) { (void)to, (void)number, (void)length; }
